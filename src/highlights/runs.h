/* runs.h: the runs of pixels that lamps are listed as, in the window (highlights.h). */
#ifndef RF_RUNS_H
#define RF_RUNS_H

#include <stdbool.h>
#include <stdlib.h>

#include "highlights/highlights.h"
#include "image/viewport.h"
#include "renderer/renderer.h"

/* Where in the window pixel i of a run is; false: not in it. */
static inline bool rf_place_of(const struct refocus_renderer *r, const struct rf_highlight *lamp,
                               int i, int *x, int *y)
{
    *x = lamp->x + i - r->view.x0;
    *y = lamp->y - r->view.y0;
    return *x >= 0 && *y >= 0 && *x < r->view.width && *y < r->view.height;
}

/* The pixels of a run that are in the window, and so many around them there; empty: none are. */
static inline struct rf_rect rf_around_run(const struct refocus_renderer *r,
                                           const struct rf_highlight *lamp, int by)
{
    const int x0 = lamp->x - r->view.x0, x1 = x0 + lamp->count, y = lamp->y - r->view.y0;

    if (y < 0 || y >= r->view.height || x1 <= 0 || x0 >= r->view.width)
        return (struct rf_rect){0, 0, 0, 0};
    return (struct rf_rect){rf_within(x0 - by, r->view.width), rf_within(y - by, r->view.height),
                            rf_within(x1 + by, r->view.width),
                            rf_within(y + by + 1, r->view.height)};
}

/* The least and the greatest blur somewhere. */
struct rf_blurs {
    int least, most;
    int sharpest; /* least |s| */
};

static inline struct rf_blurs rf_blurs_in(const struct refocus_renderer *r, struct rf_rect rect)
{
    struct rf_blurs in = {INT16_MAX, INT16_MIN, INT16_MAX};

    for (int y = rect.y0; y < rect.y1; y++) {
        const int16_t *s = r->blur.at + y * r->view.stride;

        for (int x = rect.x0; x < rect.x1; x++) {
            in.least = s[x] < in.least ? s[x] : in.least;
            in.most = s[x] > in.most ? s[x] : in.most;
            in.sharpest = abs(s[x]) < in.sharpest ? abs(s[x]) : in.sharpest;
        }
    }
    return in;
}

#endif
