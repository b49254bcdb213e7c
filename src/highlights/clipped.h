/* clipped.h: what finding lamps, drawing them and their rims have in common. */
#ifndef RF_CLIPPED_H
#define RF_CLIPPED_H

#include "image/viewport.h"
#include "renderer/renderer.h"

enum { RF_CLIPPED = RF_LIGHT_MAX * 94 / 100 }; /* light from which clipping begins to count */

/* 0 to 256 as v goes from a to b. */
static inline int rf_ramp(int64_t v, int64_t a, int64_t b)
{
    return v >= b ? 256 : v <= a ? 0 : (int)(256 * (v - a) / (b - a));
}

/* Of the front's channels at a pixel. */
static inline int rf_brightest_at(const struct refocus_renderer *r, ptrdiff_t at)
{
    int most = r->light.channel[0][at];

    most = r->light.channel[1][at] > most ? r->light.channel[1][at] : most;
    return r->light.channel[2][at] > most ? r->light.channel[2][at] : most;
}

#endif
