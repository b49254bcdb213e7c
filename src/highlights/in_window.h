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

/* The most that blurs around one may differ by for a run to be drawn as one disc, 1/256 pixel: half
 * a pixel, and 1/32 of large ones. */
static inline int rf_alike_within(int blur)
{
    const int size = blur < 0 ? -blur : blur;

    return size < 4096 ? 128 : size / 32;
}

/* Where in the window pixel i of a run is; false: it is not in the window. */
static inline bool rf_place_in(const struct rf_viewport *view, const struct rf_highlight *run,
                               int i, int *x, int *y)
{
    *x = run->x + i - view->x0;
    *y = run->y - view->y0;
    return *x >= 0 && *y >= 0 && *x < view->width && *y < view->height;
}

/* The pixels of a run that are in the window, and so many around them there; empty: none are. */
static inline struct rf_rect rf_around_run(const struct rf_viewport *view,
                                           const struct rf_highlight *run, int by)
{
    const int x0 = run->x - view->x0, x1 = x0 + run->count, y = run->y - view->y0;

    if (y < 0 || y >= view->height || x1 <= 0 || x0 >= view->width)
        return (struct rf_rect){0, 0, 0, 0};
    return (struct rf_rect){rf_within(x0 - by, view->width), rf_within(y - by, view->height),
                            rf_within(x1 + by, view->width), rf_within(y + by + 1, view->height)};
}

/* Whether pixel i of a run is mostly the silhouette of something sharper (rf_mark_highlights()). */
static inline bool rf_is_edge(const struct rf_highlight *run, int i)
{
    return run->edges >> i & 1;
}

/* The blur of a pixel of the window, 1/256 pixel. */
static inline int rf_window_blur(const struct rf_highlight_window *w, int x, int y)
{
    return rf_in_pixels(w->blur.at[y * w->blur.stride + x], w->blur.unit);
}

/* The blurs of a region, 1/256 pixel. */
struct rf_blur_extent {
    int least, most;
    int sharpest; /* least |s| */
};

static inline struct rf_blur_extent rf_blur_extent(const struct rf_blur_q8 *blur,
                                                   struct rf_rect rect)
{
    struct rf_blur_extent in = {INT16_MAX, INT16_MIN, INT16_MAX};

    for (int y = rect.y0; y < rect.y1; y++) {
        const int16_t *s = blur->at + y * blur->stride;

        for (int x = rect.x0; x < rect.x1; x++) {
            in.least = s[x] < in.least ? s[x] : in.least;
            in.most = s[x] > in.most ? s[x] : in.most;
            in.sharpest = abs(s[x]) < in.sharpest ? abs(s[x]) : in.sharpest;
        }
    }
    return (struct rf_blur_extent){rf_in_pixels(in.least, blur->unit),
                                   rf_in_pixels(in.most, blur->unit),
                                   rf_in_pixels(in.sharpest, blur->unit)};
}

/* How much of its light a pixel of a highlight keeps, 0 to 256: less where it is but the edge, by
 * its depth, of something bright and sharper. */
int rf_edge_weight(const struct rf_highlight_window *window, int x, int y);

#endif
