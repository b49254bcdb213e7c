/* corners.h: the hidden background of a tile, without seams between tiles.
 *
 * A ray that meets no surface looks as far into the hidden background as the blur of that says.
 * One blur for all pixels of a tile keeps the offset of a ray constant. Where tiles differ, rays on
 * either side of their border would look to other places, and it would be seen. There the blur is
 * averaged at each corner, over the deepest of the four tiles that meet in it, the means of the
 * tile are computed for the blur of each corner, and interpolated bilinearly.
 *
 * An example: the hidden background of a tile has a blur of 20 pixels, as has all around but for
 * the tiles to the right, with 4. Left corners have 20, right ones 12: pixels of column 8 are half
 * of either, and from the next tile's first column on it goes on from 12 to 4.
 */
#ifndef RF_CORNERS_H
#define RF_CORNERS_H

#include <stdbool.h>

#include "gather/frame.h"

/* The corners of a tile, rows first; those that hardly differ across or down are one. */
struct rf_corners {
    bool across, down; /* Corners differ from column to column, from row to row. */
    int count;         /* 1, 2 or 4 */
    int blur[4];       /* as blurs are stored */
};

void rf_find_corners(struct rf_corners *corners, const struct rf_frame *f, int tx, int ty);

/* Whether means are those of the corner before: no ray looks past all slabs, for which the blur of
 * the hidden background would count, and the rows that are computed are the same. */
bool rf_corner_repeats(const struct rf_corners *corners, int k, const struct rf_frame *f,
                       const struct rf_tile_plan *plan, bool past_slabs);

/* Means of a tile that are being interpolated: of pixels, or of chroma, whose samples are two
 * pixels apart across, U and V by turns, and `down` pixels from row to row. */
struct rf_corner_layout {
    int across, down;
};

/* Adds the means for corner k to a sum, which the first of them begins. */
void rf_add_corner(uint32_t *sum, const uint16_t *mean, const struct rf_corners *corners, int k,
                   struct rf_corner_layout layout);

/* Replaces means by those that were added up for all corners. */
void rf_corner_means(uint16_t *mean, const uint32_t *sum, struct rf_corner_layout layout);

#endif
