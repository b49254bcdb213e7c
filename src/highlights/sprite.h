/* sprite.h: the aperture as the sprite that a run of a highlight's pixels is drawn as.
 *
 * A sprite is drawn in layers, each of its own shape. The first chords of all rows of an aperture
 * are a layer, the second ones another. With colour fringes red and blue have theirs, and green,
 * which has another radius, has its own. Apertures that are not evenly open, as masks, have one
 * shape, of summed light (struct rf_summed_light).
 */
#ifndef RF_SPRITE_H
#define RF_SPRITE_H

#include <stdbool.h>
#include <stdint.h>

#include "highlights/visibility.h"
#include "kernels/discs.h"

/* A run as it is seen from a tile. */
struct rf_sprite {
    struct rf_disc_job job; /* chords in each row of the tile; of summed light, how far it goes */
    int channel[3];         /* channels of the job's planes */
    bool faint[3];          /* light of a plane is 1/256 as bright: else it would be rounded away */
    int most[3];            /* light that a pixel of a plane gets at most, 1/256 if faint */
    int times;              /* one of chords is drawn so often: brighter ones exceed 16 bits */
    double whole[3];        /* light of the run in all pixels, Q14, or 1/256 if faint */
    const struct rf_summed_side *summed; /* NULL: it is one of chords */
};

int rf_sprite_layers(const struct rf_splat *splat);

/* Puts a run in a layer. */
void rf_sprite_set_layer(struct rf_splat_run *run, const struct rf_splat *splat, int layer);

/* Whether discs of the radius of a run reach into the tile. */
bool rf_sprite_reaches(const struct rf_splat_run *run);

/* Makes the sprite of a run in its layer for the means of a tile; false: it does not reach them or
 * has no light there. */
bool rf_sprite_make(struct rf_sprite *sprite, const struct rf_visibility *tile,
                    const struct rf_splat_run *run);

/* Sprites of summed light: sets the job's chords to how far that goes; adds it to planes of means,
 * as kernels->draw_disc does. */
void rf_sprite_set_extent(struct rf_sprite *sprite, const struct rf_splat *splat,
                          const struct rf_splat_run *run);
void rf_sprite_draw_summed(uint16_t *const mean[3], const struct rf_sprite *sprite,
                           const struct rf_splat *splat, const struct rf_splat_run *run);

#endif
