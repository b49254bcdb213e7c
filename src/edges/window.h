/* window.h: the windows around a pixel in which others vote on its disparity. */
#ifndef RF_EDGES_WINDOW_H
#define RF_EDGES_WINDOW_H

#include "edges/edges.h"
#include "support/compare.h"
#include "support/exp_minus.h"

enum {
    RF_VOTE_REACH = 15, /* most pixels to each side */
    RF_NARROW_REACH = (RF_VOTE_COLUMNS - 1) / 2,
    RF_CUT_REACH = 10, /* less is cut off to the one above: twice the columns cost twice as much */
    RF_VOTE_STEP = 2,  /* rows: every other one is looked at */
    RF_VOTE_MIDDLE = RF_MOST_VOTE_COLUMNS - 1,
};
_Static_assert(2 * RF_VOTE_REACH + 1 <= RF_MOST_VOTE_COLUMNS &&
                   2 * (RF_VOTE_REACH / RF_VOTE_STEP) + 1 <= RF_MOST_VOTE_ROWS,
               "no window is larger than the kernels take");

struct rf_vote_shape {
    int reach, step, columns;
    /* A Gaussian in 1/255 around [RF_VOTE_REACH][RF_VOTE_MIDDLE], and 0 beyond the reach, so that a
     * window may lie anywhere around its pixel. */
    uint8_t nearness[2 * RF_VOTE_REACH + 1][2 * RF_VOTE_MIDDLE + 1];
};

/* spread: the Gaussian's standard deviation, in reaches. */
static inline struct rf_vote_shape rf_vote_shape(double softness, double spread)
{
    const int whole = rf_smaller(rf_larger((int)(3.5 * softness), 6), RF_VOTE_REACH);
    const int reach = whole < RF_CUT_REACH ? rf_smaller(whole, RF_NARROW_REACH) : whole;
    struct rf_vote_shape shape = {.reach = reach,
                                  .step = RF_VOTE_STEP,
                                  .columns = 2 * reach < RF_VOTE_COLUMNS ? RF_VOTE_COLUMNS
                                                                         : RF_MOST_VOTE_COLUMNS};

    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const double off = (x * x + y * y) / (2 * spread * whole * spread * whole);

            shape.nearness[RF_VOTE_REACH + y][RF_VOTE_MIDDLE + x] =
                (uint8_t)(255 * rf_exp_minus(off) + 0.5);
        }
    return shape;
}

/* A window around pixel (x, y), within the planes: its first pixel and rows. */
struct rf_vote_place {
    ptrdiff_t first;
    int rows;
    const uint8_t *nearness;
};

static inline struct rf_vote_place rf_place_window(const struct rf_edges *e,
                                                   const struct rf_vote_shape *shape, int x, int y)
{
    const int above = rf_smaller(shape->reach, y) / shape->step;
    const int below = rf_smaller(shape->reach, e->height - 1 - y) / shape->step;
    const int last = rf_larger(e->width - shape->columns, 0);
    const int left = rf_smaller(rf_larger(x - shape->reach, 0), last);

    return (struct rf_vote_place){
        .first = (y - above * shape->step) * e->stride + left,
        .rows = above + 1 + below,
        .nearness =
            &shape->nearness[RF_VOTE_REACH - above * shape->step][RF_VOTE_MIDDLE - (x - left)],
    };
}

#endif
