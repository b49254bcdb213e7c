/* thin.h: thin things, and the edges beside them, taken apart.
 *
 * A wire of two pixels that is blurred over forty is met by few rays, here by more and
 * there by less: it shows as streaks. And the pixels at its edge that have the depth of
 * what is behind stay there as a sharp line. All of them are mixtures of the wire, N,
 * and of what is behind, F,
 *
 *     C = alpha N + (1 - alpha) F
 *
 * So they are taken apart: the planes get F, at its depth, and alpha N is drawn over
 * the picture (veil.h). That is done where the near thing is thin, far before the
 * focus, and nothing thick that is as near reaches the tile.
 *
 * F is the mean of the pixels around of the far surface that counts most, each by the
 * inverse square of its distance; N that of the near ones around by how much they
 * differ from F. alpha is the share of N - F in C - F, at least as much as keeps N
 * between black and white. Where C tells nothing it is 1, if the map has the pixel
 * near.
 */
#ifndef RF_THIN_H
#define RF_THIN_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/thin.h"

struct refocus_renderer;
struct rf_frame;

/* Those of a tile, of all that are in its row of tiles. */
struct rf_thin_run {
    uint32_t first;
    uint16_t count;
    uint16_t least, most; /* near disparities; 65535 and 0 of none */
};

/* Room for those of a row of tiles: one pixel in four; further ones stay as they are.
 */
static inline uint64_t rf_thin_capacity(int width)
{
    return (uint64_t)((width + 15) / 16) * 64;
}

struct rf_thin_list {
    struct rf_thin *pixel; /* rf_thin_capacity() for each row of tiles; while the planes
                              have F, the light of each is that of the photo */
    struct rf_thin_run *run; /* of each tile */
    uint32_t blend;          /* that they were found in, or RF_NO_BLEND */
};

/* Find those of the photo in use, all of which is in the window, in r->blend. */
void rf_find_thin(struct refocus_renderer *r);

/* Those of a tile of the window. */
const struct rf_thin_run *rf_thin_run_of(const struct refocus_renderer *r, int tx,
                                         int ty);
struct rf_thin *rf_thin_of(const struct refocus_renderer *r, int tx, int ty,
                           uint32_t *count);

/*
 * Nothing is to jump as the focus moves, so that not all pixels are taken apart at one blur: those
 * of a level k, that of their cell of 4 x 4 pixels in the tile, are from veil_blur (1 + k / 64) on.
 */
enum { RF_VEIL_LEVELS = 16 };

/* Blur of what is near in one of a tile, Q7.8, and whether that is far enough before
 * the focus. */
int rf_near_blur(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty);
bool rf_is_veil(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty);

/* f->veil_from, from veil_blur: of a plan that is a lens's the least disparity that is, of each
 * level; 65536: none. */
void rf_set_veils(struct rf_frame *f);

/* After blurs, cells and bins, before rims: choose the tiles whose edges are taken
 * apart; there blurs become those of F, and the veil is drawn. */
void rf_take_thin_apart(struct rf_frame *f);

/* Whether those of a tile are. */
bool rf_thin_drawn(const struct refocus_renderer *r, int tx, int ty);

/* Means of a tile, Q14, that nothing reaches but what is drawn: the photo, and F. */
void rf_sharp_means(const struct rf_frame *f, int tx, int ty, uint16_t mean[3][256]);

/* Exchange the light in the photo with that in the list, where they are: before the
 * pre-filter, and back after it. */
void rf_swap_thin_light(const struct rf_frame *f);

#endif
