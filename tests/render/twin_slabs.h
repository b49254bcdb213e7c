/* twin_slabs.h: the slabs of the tiles of a twin's picture. */
#ifndef RENDER_TWIN_SLABS_H
#define RENDER_TWIN_SLABS_H

#include "twin.h"

enum { TWIN_BINS = 256 };

struct twin_slab {
    double low, high, centre; /* hit if low <= s <= high */
    double least, most;       /* extremes of the blurs that the slab is for */
};

struct twin_plan {
    int slabs;
    struct twin_slab slab[TWIN_BINS];
    double reach;
    bool sharp;
};

/* The bin of a blur, of bins of a width; 0: as of large units. */
int twin_bin_of(double width, double s);

/* The plans of all tiles, row by row; to be freed. */
struct twin_plan *twin_plans(const struct twin *t, int across, int down);

#endif
