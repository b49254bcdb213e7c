/* in_window.h: the runs of pixels that highlights are listed as, where they lie in the window. */
#ifndef RF_HIGHLIGHTS_IN_WINDOW_H
#define RF_HIGHLIGHTS_IN_WINDOW_H

#include <stdbool.h>
#include <stdlib.h>

#include "highlights/highlights.h"

/* The parts of the list that the window has rows of. */
struct rf_highlight_parts {
    int first, count;
};
struct rf_highlight_parts rf_parts_in(const struct rf_viewport *view);

/* The first run of a sorted list, from `run` to `end`, that is at (x, y) of the photo or behind it:
 * farther right, or lower; `end` if there is none. */
struct rf_highlight *rf_first_run(struct rf_highlight *run, const struct rf_highlight *end, int x,
                                  int y);

/* Where in the window pixel i of a run is; false: it is not in the window. */
static inline bool rf_place_in(const struct rf_viewport *view, const struct rf_highlight *run,
                               int i, int *x, int *y)
{
    *x = run->x + i - view->x0;
    *y = run->y - view->y0;
    return *x >= 0 && *y >= 0 && *x < view->width && *y < view->height;
}

/* The blur of a pixel of the window, 1/256 pixel. */
static inline int rf_window_blur(const struct rf_highlight_window *w, int x, int y)
{
    return rf_in_pixels(w->blur.at[y * w->blur.stride + x], w->blur.unit);
}

/* The most that blurs of a run around one at (x, y) of the window may differ by for it to be drawn
 * as one disc, 1/256 pixel: half a pixel, 1/32 of large ones, or what the noise of the map there
 * makes of one blur. */
static inline int rf_alike_within(const struct rf_highlight_window *w, int x, int y, int blur)
{
    const int size = blur < 0 ? -blur : blur;
    const int noise = w->bins[(size_t)(y / RF_TILE) * w->view->tiles_x + x / RF_TILE].noise;
    const int within = size < 4096 ? 128 : size / 32;
    const int noisy = 2 * rf_in_pixels(noise, w->blur.unit);

    return noisy > within ? noisy : within;
}

#endif
