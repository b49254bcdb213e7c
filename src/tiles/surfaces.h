/* surfaces.h: level surfaces of a noisy depth map, each of which is one slab.
 *
 * Noise spreads the blurs of a surface over many slabs, which all rays would have to test, and of
 * which each pixel is in another: near the focus it would be sharp here and blurred there. Where
 * a tile is one surface and level, its blur is the mean, and all that lies within the noise of that
 * mean is seen with it. Tiles beside it, where surfaces meet, take the same slabs.
 *
 * An example: a subject in focus has noise of a standard deviation of 0.8 pixels, so that `noise`
 * is about 2. Its tiles have blurs of -2.6 to 2.6 and means of -0.1 to 0.1, and one slab from -4 to
 * 4 pixels with the centre 0: they are sharp. Without that they would take twelve slabs.
 */
#ifndef RF_SURFACES_H
#define RF_SURFACES_H

#include <stdbool.h>

#include "tiles/tiles.h"

enum {
    RF_NOISE_TIMES = 3,   /* slabs of noise are so many times as wide as rf_bins has it: it overlaps
                             by 2.5 standard deviations, and nearly all of it lies within 7 */
    RF_MOST_SURFACES = 9, /* A tile and the eight around it have one each. */
};

struct rf_level_surface {
    int first, end; /* bins from first to end - 1 are of it */
    int middle;     /* the blur that it is seen with */
    int noise;      /* as in rf_bins, but no more than the widest slab allows */
    bool own;       /* It is the surface of the tile itself, not of one around it. */
};

struct rf_level_surfaces {
    int count;
    struct rf_level_surface at[RF_MOST_SURFACES]; /* nearest first */
};

/* Finds the surfaces of tile (tx, ty) and of those around it. Bins between two of them belong to
 * the one whose mean is nearer. None is wider than `widest`, or has blurs of a tile in reach that
 * is without noise. */
void rf_find_surfaces(const struct rf_viewport *view, const struct rf_bins *bins,
                      const struct rf_bins_in_reach *in_reach, struct rf_bin_scale scale, int tx,
                      int ty, int widest, struct rf_level_surfaces *surfaces);

#endif
