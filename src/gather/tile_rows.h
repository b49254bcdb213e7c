/* tile_rows.h: decides which rows of a tile are computed and which are interpolated.
 *
 * Where everything in reach is blurred, a picture has no detail as fine as its rows, and some
 * of them are as good as all: a disc of radius s passes less than 0.15 of what changes faster
 * than every 1.6 s pixels, which rows 0.8 s apart show. So 64 rays have rows a pixel apart for
 * 1.25 pixels of blur; fewer rays, which lie farther apart, have them for less, but for one pixel
 * of blur at the least. The rows between are interpolated by cubics. The first and the last row are
 * always computed, so that tiles meet without a seam and depend on no other.
 */
#ifndef RF_TILE_ROWS_H
#define RF_TILE_ROWS_H

#include "gather/frame.h"

/* `count` rows that lie `step` apart. Where they are two apart, the rows of the lower half lie one
 * further down: 0 2 4 6 9 11 13 15. */
struct rf_tile_rows {
    int step, count;
};

static inline int rf_row_at(struct rf_tile_rows rows, int i)
{
    return i * rows.step + (rows.step == 2 && i >= rows.count / 2);
}

/* The blur, Q7.8, from which on rows may lie a pixel apart: n times that allows n pixels. 0 means
 * that every row is needed, because of the settings or of an aperture with fine structure. */
int rf_row_gap(const struct rf_frame *f);

/* The least blur of everything that rays of a tile can hit, the hidden background included; 1/256
 * pixel. The rows and the softness of a tile depend on its hidden background by that alone. */
int rf_least_blur(const struct rf_frame *f, const struct rf_tile_plan *plan, int background_blur);

/*
 * How much means of a tile are softened (kernels->soften), Q16: where rays of the preset lie 1.5
 * pixels and more apart, the rays of a pixel hit other pixels than those of its neighbours, which
 * shows as a fine weave. Where everything in reach is blurred by 2.5 pixels the picture has no
 * detail as fine. Softening sets in gradually and is whole from 5/4 of both limits on, so that
 * nothing jumps as the focus moves. Rows and columns at a tile's border
 * stay, as their neighbours are in other tiles.
 */
uint16_t rf_softness(const struct rf_frame *f, const struct rf_tile_plan *plan,
                     int background_blur);

/* The rows of a tile whose hidden background has that blur. */
struct rf_tile_rows rf_tile_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                 int background_blur);

/* The rows of chroma in 4:2:0, where a tile has eight of them, two pixels apart: 0 2 5 7, or all.
 */
struct rf_tile_rows rf_chroma_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                   int background_blur);

#endif
