/* rect.h: rectangles of pixels. */
#ifndef RF_RECT_H
#define RF_RECT_H

#include <stdbool.h>

/* Pixels x0 <= x < x1, y0 <= y < y1. */
struct rf_rect {
    int x0, y0, x1, y1;
};

/* The number from 0 to `most` that is nearest to v. */
static inline int rf_within(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

#endif
