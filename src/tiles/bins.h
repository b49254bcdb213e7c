/* bins.h: the bins of a tile: which circles of confusion occur in it. */
#ifndef RF_BINS_H
#define RF_BINS_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/slab.h"

/* Occupied bins of signed blur, a bit each, nearest first, and the extremes in them. Blurs are as
 * they are stored. */
struct rf_bins {
    uint64_t word[RF_BINS / 64];
    int16_t least, most;
    int16_t highlight;    /* largest |s| of a highlight; 0: it has none */
    int16_t undersampled; /* largest |s| of a highlight narrower than the gaps between rays need */
    int16_t background_blur; /* blur of the hidden background in the middle of the tile */
    uint16_t brightest;      /* an upper bound of the light of either layer, as it is summed */
    int16_t noise;           /* blurs vary so far from pixel to pixel; 0: the map is clean */
    int16_t middle;          /* the mean of its blurs; only if `flat` */
    bool steep;              /* a surface of the tile is so steep that rays can pass it */
    bool flat;               /* the tile is one level surface, but for its noise */
    bool subtracted;         /* highlights are subtracted from its light, highlights/subtract.c */
};

/* The least and the greatest circle of confusion around each cell of a window; tiles/ranges.h. */
struct rf_range_plane {
    uint32_t *at; /* address of the cell of pixel (0, 0) */
    ptrdiff_t stride;
};

#endif
