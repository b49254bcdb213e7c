/* around.h: what lies around a pixel, as far as the window goes. */
#ifndef RF_AROUND_H
#define RF_AROUND_H

#include "renderer/renderer.h"

/* The nearest of 0 to `most`. */
static inline int rf_within(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* (x, y) and so many pixels on each side. */
static inline struct rf_rect rf_around(const struct refocus_renderer *r, int x, int y, int by)
{
    const int right = r->width - 1, bottom = r->height - 1;

    return (struct rf_rect){rf_within(x - by, right), rf_within(y - by, bottom),
                            rf_within(x + by, right) + 1, rf_within(y + by, bottom) + 1};
}

#endif
