/* visibility.h: which part of a highlight the pixels of a tile see past nearer surfaces. */
#ifndef RF_VISIBILITY_H
#define RF_VISIBILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "highlights/highlights.h"
#include "kernels/discs.h"
#include "tiles/tiles.h"

enum {
    RF_SPLAT_UNIT = 64, /* units of length in a pixel */
    RF_SHADES = 16,
};

/* A run of a highlight's pixels, or some rows of them as one, as a tile sees it: places count from
 * the middle of the tile's first pixel. */
struct rf_splat_run {
    int from, to;     /* RF_SPLAT_UNIT */
    int middle, rows; /* half pixels; so many */
    int turn;         /* number of the run among those of as many rows, in the photo */
    int set;          /* number of the chord in each row of the aperture; rows may have several */
    int blur;         /* Q7.8, signed */
    int radius;
    double light[3]; /* light of all its pixels, Q12 times 256 */
};

/* Visibility of a run past one slab. Runs of about one place are hidden alike: all rows of a
 * highlight are occluded by something in focus, the slab just before them hides each otherwise.
 * So a shade that was found for one serves for those whose looks at the slab are no farther than
 * a quarter of a pixel from its own; with half a pixel, highlights behind hair flicker as the
 * focus moves. */
struct rf_shade {
    struct rf_look_at {
        struct rf_splat_run run;
        int first, end; /* rows of the tile that its discs reach */
        int slab;
    } look;
    enum rf_hidden { RF_HIDDEN_NOWHERE, RF_HIDDEN_PARTLY, RF_HIDDEN_WHOLLY } hidden;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* where hidden partly */
};

/* Slabs that highlights are seen past from a tile, and the last shades, which may serve again. */
struct rf_visibility {
    const struct rf_splat *splat;
    int tx, ty, slabs;
    struct rf_slab slab[RF_MAX_SLABS]; /* slabs of the tile; ones that lie close are merged */
    int count;                         /* shades that were kept so far */
    struct rf_shade shade[RF_SHADES], other;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* past more than one slab */
};

void rf_visibility_begin(struct rf_visibility *tile, const struct rf_splat *splat,
                         const struct rf_tile_plan *plan, int tx, int ty);

/* How much of a run is hidden, at a glance: what is hidden in part by it may not be at all. The
 * job's shape is set. `clear`: slabs that hide nothing of it, a bit each of the first 64. */
enum rf_hidden rf_run_hidden(const struct rf_visibility *tile, const struct rf_disc_job *job,
                             const struct rf_splat_run *run, uint64_t *clear);

/* Sets job->visible, in `tile`, for a run of one row or two; false: it is hidden. `clear`: the
 * slabs that hide nothing of a run that it is part of. */
bool rf_run_visible(struct rf_visibility *tile, struct rf_disc_job *job,
                    const struct rf_splat_run *run, uint64_t clear);

#endif
