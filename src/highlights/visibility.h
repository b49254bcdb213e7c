/* visibility.h: which part of a splatted highlight each pixel of a tile sees, and which part nearer
 * surfaces occlude. */
#ifndef RF_VISIBILITY_H
#define RF_VISIBILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "highlights/highlights.h"
#include "kernels/discs.h"
#include "tiles/tiles.h"

enum {
    RF_SPLAT_UNIT = 64, /* units of length in a pixel */
    RF_KEPT_OCCLUSIONS = 16,
};

/* A run of a highlight's pixels in a row, or the mean of some rows of them, as a tile sees it:
 * places count from the middle of the tile's first pixel. */
struct rf_splat_run {
    int from, to;     /* RF_SPLAT_UNIT */
    int middle, rows; /* place of the middle in half pixels, and number of rows */
    int turn;         /* number of the run among those of as many rows, in the photo */
    int layer;        /* number of the layer (sprite.h) */
    int blur;         /* 1/256 pixel, signed */
    int radius;       /* radius of its disc in this layer */
    double across;    /* factor of the way that rays go on the other side of the focus */
    double light[3];  /* light of all its pixels, Q12 times 256 */
};

/* An occlusion tells which pixels of a tile see a run past the surfaces of one slab. A slab in
 * focus occludes all rows of a highlight alike, one just before the highlight occludes each row in
 * its own way. So what was found for one run is used again for others whose rays pass the slab no
 * farther than a quarter of a pixel away. With half a pixel, highlights beyond hair flicker as the
 * focus moves. */
struct rf_occlusion {
    struct rf_look_at {
        struct rf_splat_run run;
        int first, end; /* rows of the tile that its discs reach */
        int slab;
    } look;
    enum rf_hidden { RF_HIDDEN_NOWHERE, RF_HIDDEN_PARTLY, RF_HIDDEN_WHOLLY } hidden;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* set if hidden partly: all bits where it is seen */
};

/* The slabs of a tile that may occlude highlights, and the last occlusions, which may be used
 * again. */
struct rf_visibility {
    const struct rf_splat *splat;
    int tx, ty, slabs;
    int nearer; /* 1/256 pixel: a surface has to be nearer by so much to occlude a highlight */
    struct rf_slab slab[RF_MAX_SLABS]; /* slabs of the tile; ones that lie close are merged */
    int count;                         /* occlusions that were found so far */
    struct rf_occlusion occlusion[RF_KEPT_OCCLUSIONS], other;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* a mask for more than one slab */
};

void rf_visibility_begin(struct rf_visibility *tile, const struct rf_splat *splat,
                         const struct rf_tile_plan *plan, int tx, int ty);

/* How much of a run is hidden, by the ranges of blur alone, so that a run that is hidden partly may
 * not be hidden at all. The job's shape is set. `clear`: slabs that hide nothing of it, a bit each
 * of the first 64. */
enum rf_hidden rf_run_hidden(const struct rf_visibility *tile, const struct rf_disc_job *job,
                             const struct rf_splat_run *run, uint64_t *clear);

/* Sets job->visible, in `tile`, for a run of one row or two; false: it is hidden. `clear`: the
 * slabs that hide nothing of a run that it is part of. */
bool rf_run_visible(struct rf_visibility *tile, struct rf_disc_job *job,
                    const struct rf_splat_run *run, uint64_t clear);

#endif
