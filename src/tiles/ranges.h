/* ranges.h: the least and the greatest blur in the window around each place, which save rays tests.
 *
 * A strip of a tile that is shifted by a ray's offset lies within a window of some cells of RF_CELL
 * x RF_CELL pixels. The range of a window is the least and the greatest blur in it, kept at its
 * first cell (kernels/ranges.h, windows). A slab with no blur of the range need not be tested, and
 * a slab that holds all of them ends the ray without a test.
 *
 * An example: the strip from pixel (32, 16) on, shifted by (5, 2), covers columns 37 to 52 and rows
 * 18 to 25, so cells 9 to 13 across and 4 to 6 down: the window at cell (9, 4). If its blurs go
 * from 2.1 to 2.8, a ray passes the slab 1 to 2 there without a test, and ends in the slab 2 to 3
 * without one: every pixel of the strip hits. If they go from 2.1 to 9, the slab 2 to 3 has to be
 * tested.
 *
 * A wall of blur 9 is the deepest surface there, and where nothing near its depth is marked as
 * foreground it is in the background layer too: RF_IN_BACKGROUND. Rays that have passed the nearer
 * slabs see the layer there, without a test of the slab 8.5 to 9.5.
 *
 * All functions work on a row of tiles, and may run for several rows at once.
 */
#ifndef RF_RANGES_H
#define RF_RANGES_H

#include "image/planes.h"
#include "image/viewport.h"
#include "kernels/kernels.h"
#include "support/executor.h"
#include "tiles/bins.h"

/* The least and the greatest blur of each cell, Q7.8: cell (x, y) is at [y * stride + x]. */
struct rf_cells {
    int16_t *least, *most;
    ptrdiff_t stride;
};

/* The greatest blur, Q7.8, of the pixels of a cell that occlude something, which are other pixels
 * in the background layer; RF_NO_BLUR: there are none. */
struct rf_foreground_cells {
    int16_t *most;
    ptrdiff_t stride;
};

/* Cells on each side of the picture. */
static inline int rf_range_border(int pad)
{
    return (pad + RF_CELL - 1) / RF_CELL;
}

/* Cells across, or down, with the border on both sides. */
static inline int rf_range_width(int width, int pad)
{
    return (width + RF_TILE - 1) / RF_TILE * (RF_TILE / RF_CELL) + 2 * rf_range_border(pad);
}

/* Writes the cells of row ty from its blurs. */
void rf_cell_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                  struct rf_blur_q8 blur, const struct rf_cells *cells, int ty);

/* Adds a blur to the cell of pixel (x, y). */
void rf_add_to_cell(const struct rf_cells *cells, int x, int y, int16_t blur);

/* Arguments of the passes that make ranges, and where these go. */
struct rf_range_pass {
    struct rf_cells cells;                 /* read by rf_range_rows() */
    struct rf_foreground_cells foreground; /* read by rf_mark_ranges_in_background() */
    bool whole_tiles;                      /* ranges are of both strips of a tile: a photo of Y, U
                                              and V is swept a tile at a time */
    struct rf_range_plane range;           /* written */
};

/* Writes the ranges of row ty, from the cells of all rows. RF_IN_BACKGROUND is still clear. */
void rf_range_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                   const struct rf_range_pass *pass, int ty, int worker);

/* Writes the foreground of the cells of row ty, once the background is inpainted. Both planes of
 * blur have the same stride. */
void rf_foreground_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                        struct rf_blur_q8 blur, struct rf_blur_q8 background_blur,
                        const struct rf_foreground_cells *foreground, int ty);

/* Makes the cells of a rectangle of pixels foreground whatever their blur; x1 and y1 are part of
 * it. */
void rf_force_foreground(const struct rf_viewport *view,
                         const struct rf_foreground_cells *foreground, struct rf_rect pixels);

/* Sets RF_IN_BACKGROUND (kernels/ranges.h) in the ranges of row ty, from the foreground of all
 * rows.
 */
void rf_mark_ranges_in_background(const struct rf_executor *exec, const struct rf_viewport *view,
                                  const struct rf_range_pass *pass, int ty, int worker);

#endif
