/* blocks.h: sums over the edges in blocks of a disparity map, for shifts of the map by some pixels.
 */
#ifndef RF_EDGES_BLOCKS_H
#define RF_EDGES_BLOCKS_H

#include <math.h>

#include "edges/edges.h"

enum {
    RF_MOST_SHIFTS = 89, /* shifts that are no longer than sqrt(RF_EDGE_SHIFT^2 + 1) */
    RF_LARGE_BLOCK = 16,
    RF_SMALL_BLOCK = 8,
    RF_SMALL_REACH = 3,
    RF_MOST_VALUES = 128, /* numbers whose median is looked for */
};

struct rf_shift {
    int x, y;
};

/* The edges of a map, summed up block by block and smoothed over neighbouring blocks. */
struct rf_blocks {
    struct rf_edges *e;
    int side, across, down;
    int reach, columns; /* a window of shifts has 2 reach + 1 rows of columns */
    int shifts, every;
    struct rf_shift shift[RF_MOST_SHIFTS];
    double length[RF_MOST_SHIFTS];
    int32_t *support;      /* for each block, its window of shifts */
    int32_t *count;        /* number of edges, in 1/256 */
    double *right, *below; /* where the edges of a block fit best, pixels */
    double *weight;
    int64_t total[RF_MOST_SHIFTS];
};

/* Where there are many, more than five a block of 16 x 16 pixels, every second edge is looked at,
 * every third, and so on. */
static inline int rf_every_edge(const struct rf_edges *e)
{
    const int64_t enough = (int64_t)e->width * e->height / 48;

    return (int)(e->edges / (enough > 8192 ? enough : 8192)) + 1;
}

static inline double rf_shift_length(struct rf_shift shift)
{
    return sqrt(shift.x * shift.x + shift.y * shift.y);
}

/* Blocks of RF_LARGE_BLOCK pixels for shifts up to RF_EDGE_SHIFT, or of RF_SMALL_BLOCK for shifts
 * up to RF_SMALL_REACH. */
struct rf_blocks rf_blocks_of(struct rf_edges *e, int side, int reach);

/*
 * Finds where the edges of each block fit best. A shift that gains less than `margin` counts as
 * none. Returns the share of the edges, by how clearly they can tell, whose block wants at most a
 * pixel and a half.
 */
double rf_ask_blocks(struct rf_blocks *b, double margin);

/* The one in the middle of n values, up to RF_MOST_VALUES. */
int64_t rf_median(const int64_t *value, int n);

#endif
