/* tile_rows.h: which rows of a tile are computed.
 *
 * Where everything in reach is blurred, a picture has no detail as fine as its rows, and some
 * of them are as good as all: a disc of radius s passes less than 0.15 of what changes faster
 * than every 1.6 s pixels, which rows 0.8 s apart show. So 64 rays have rows a pixel apart for
 * 1.25 pixels of blur; fewer rays lie farther apart, and so may rows, up to a pixel for one. The
 * rows between are put in along cubics. The first and the last row are always computed, so that
 * tiles meet without a seam and depend on no other.
 */
#ifndef RF_TILE_ROWS_H
#define RF_TILE_ROWS_H

#include "gather/frame.h"

/* Rows `step` apart; those of the lower half lie one further down where they are two apart:
 * 0 2 4 6 9 11 13 15. */
struct rf_tile_rows {
    int step, count;
};

static inline int rf_row_at(struct rf_tile_rows rows, int i)
{
    return i * rows.step + (rows.step == 2 && i >= rows.count / 2);
}

/* The blur, Q7.8, for rows a pixel apart: n times that allows n pixels. 0: every row is asked for,
 * by the settings or by an opening with fine structure. */
int rf_row_gap(const struct rf_frame *f);

/*
 * How much means of a tile are softened (kernels->soften), Q16: where rays of the preset lie 1.5
 * pixels and more apart, each pixel meets others than its neighbours, which shows as a fine weave.
 * Where everything in reach is blurred by 2.5 pixels the picture has nothing as fine. Wholly from
 * 5/4 of both on, so that nothing jumps as the focus moves. Rows and columns at a tile's border
 * stay, as their neighbours are in other tiles.
 */
uint16_t rf_softness(const struct rf_frame *f, const struct rf_tile_plan *plan, int behind);

/* For a tile; the background's blur there is `behind`. */
struct rf_tile_rows rf_tile_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                 int behind);

/* Of the eight rows of chroma in 4:2:0, two pixels apart: rows 0 2 5 7, or all. */
struct rf_tile_rows rf_chroma_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                   int behind);

#endif
