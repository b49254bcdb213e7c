/* viewport.h: the part of the photo that the passes work on, its tiles and its bands of rows. */
#ifndef RF_VIEWPORT_H
#define RF_VIEWPORT_H

#include <stddef.h>

#include <refocus/image.h>

#include "image/rect.h"
#include "kernels/slab.h"

/*
 * Passes work on a window as if it were the whole picture: its pixel (0, 0) is pixel (x0, y0) of
 * the photo, a multiple of RF_TILE. It is cut into tiles of RF_TILE x RF_TILE pixels, and a band is
 * one row of tiles, which is what threads share out.
 */
struct rf_viewport {
    int photo_width, photo_height; /* pixels */
    int x0, y0;                    /* place of pixel (0, 0) in the photo */
    int width, height;             /* pixels */
    int tiles_x, tiles_y;
    int pad;               /* pixels beyond each side of a padded plane that may be read */
    struct rf_rect border; /* pixels beyond each side that rf_extend_rows() sets */
    ptrdiff_t stride;      /* elements from row to row of all padded planes */
};

enum { RF_MAX_BANDS = (REFOCUS_MAX_SIDE + RF_TILE - 1) / RF_TILE };

static inline int rf_bands(const struct rf_viewport *view)
{
    return view->tiles_y;
}

/* The first row of a band, and the row after its last one. */
static inline int rf_band_start(int band)
{
    return band * RF_TILE;
}

static inline int rf_band_end(const struct rf_viewport *view, int band)
{
    const int end = (band + 1) * RF_TILE;

    return end < view->height ? end : view->height;
}

/* Pixel (x, y) and `by` pixels on each side, as far as the window goes. */
static inline struct rf_rect rf_around(const struct rf_viewport *view, int x, int y, int by)
{
    const int right = view->width - 1, bottom = view->height - 1;

    return (struct rf_rect){rf_within(x - by, right), rf_within(y - by, bottom),
                            rf_within(x + by, right) + 1, rf_within(y + by, bottom) + 1};
}

/* A part of the photo, in pixels of the window. */
static inline struct rf_rect rf_part_in_window(const struct rf_viewport *view, struct rf_rect part)
{
    return (struct rf_rect){part.x0 - view->x0, part.y0 - view->y0, part.x1 - view->x0,
                            part.y1 - view->y0};
}

#endif
