/* ranges.h: the least and the greatest circle of confusion around each place of the window.
 *
 * A strip of a tile that is shifted by a ray's offset lies within some cells of RF_CELL x RF_CELL
 * pixels. A range holds, for the cell that the strip begins in, the least and the greatest blur of
 * all cells that it can lie in: kernels.h, windows. A slab that no blur of the range is in need not
 * be tested, and one that holds them all ends the ray without a test.
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

/* The greatest blur among those pixels of a cell that the background does not show as they are,
 * Q7.8, or RF_NO_BLUR: what hides something. */
struct rf_foreground_cells {
    int16_t *most;
    ptrdiff_t stride;
};

/* Cells on each side of the picture. */
static inline int rf_range_border(int pad)
{
    return (pad + RF_CELL - 1) / RF_CELL;
}

/* Cells across, or down, with those. */
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

/* Makes cells foreground whatever their blur: those of the pixels, the last ones too. */
void rf_force_foreground(const struct rf_viewport *view,
                         const struct rf_foreground_cells *foreground, struct rf_rect pixels);

/* Sets RF_IN_BACKGROUND (kernels/ranges.h) in the ranges of row ty, from the foreground of all
 * rows.
 */
void rf_mark_ranges_in_background(const struct rf_executor *exec, const struct rf_viewport *view,
                                  const struct rf_range_pass *pass, int ty, int worker);

#endif
