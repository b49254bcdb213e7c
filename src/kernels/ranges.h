/* ranges.h: contracts of the kernels that find the ranges of blur in cells and windows of a tile.
 */
#ifndef RF_KERNELS_RANGES_H
#define RF_KERNELS_RANGES_H

#include <stddef.h>
#include <stdint.h>

#include "kernels/slab.h"

/* Ranges are found for strips of a tile, RF_STRIP rows each. */
enum { RF_STRIP = 8, RF_STRIP_LANES = RF_TILE * RF_STRIP };

/*
 * ranges: the least and the greatest blur of cells of RF_CELL x RF_CELL pixels, and then of
 * windows of RF_WINDOW_X x RF_WINDOW_Y cells to the right of and below a cell: whatever a
 * strip that begins in that cell covers. A range is (least & 0xffff) | most << 16, with most
 * rounded up to an even number: its lowest bit is RF_IN_BACKGROUND.
 *
 * cells: one row of n cells from the four rows at `blur`.
 * windows: one row of windows from RF_WINDOW_Y rows of n cells, whose ends are repeated: the
 * first begins `border` cells to the left, the last n - 1 + border to the right. The scratch is
 * 2 (n + 2 border + RF_WINDOW_X - 1) long. RF_IN_BACKGROUND is clear.
 *
 * RF_IN_BACKGROUND says that the deepest surface of a window is in the background layer too, just
 * as it is in the picture: nothing within rf_background_depth(), which is more than a slab, of the
 * greatest blur is marked as foreground.
 *
 * foreground: one row of n cells, as cells: the greatest blur of those pixels whose background has
 * another, which differs by more than RF_INPAINTED (background.h), or RF_NO_BLUR.
 * mark_in_background: of one row of windows, from RF_WINDOW_Y rows of such cells, as windows;
 * RF_IN_BACKGROUND becomes what it should be. The scratch is n + 2 border + RF_WINDOW_X - 1 long.
 */
enum { RF_CELL = 4, RF_WINDOW_X = RF_TILE / RF_CELL + 1, RF_WINDOW_Y = RF_STRIP / RF_CELL + 1 };
enum { RF_IN_BACKGROUND = 1 << 16 };
static inline int rf_background_depth(int blur)
{
    const int size = blur < 0 ? -blur : blur, part = (size >> 3) + (size >> 5) - 256;

    return part > 320 ? part : 320;
}
static inline int16_t rf_lesser(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static inline int16_t rf_greater(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

static inline int16_t rf_range_least(uint32_t range)
{
    return (int16_t)range;
}
static inline int16_t rf_range_most(uint32_t range)
{
    return (int16_t)(range >> 16 & 0xfffe);
}
typedef void rf_cells_fn(int16_t *least, int16_t *most, const int16_t *blur, ptrdiff_t stride,
                         int n);
typedef void rf_windows_fn(uint32_t *range, const int16_t *const least[RF_WINDOW_Y],
                           const int16_t *const most[RF_WINDOW_Y], int16_t *scratch, int n,
                           int border);
typedef void rf_foreground_fn(int16_t *most, const int16_t *blur, const int16_t *background_blur,
                              ptrdiff_t stride, int n);
typedef void rf_mark_in_background_fn(uint32_t *range, const int16_t *const foreground[RF_WINDOW_Y],
                                      int16_t *scratch, int n, int border);

#endif
