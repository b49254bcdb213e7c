/* clipped.h: which light counts as clipped by the photo's white point. */
#ifndef RF_CLIPPED_H
#define RF_CLIPPED_H

#include <stddef.h>
#include <stdint.h>

#include "colour/transfer.h"
#include "image/planes.h"

enum { RF_CLIPPED = RF_LIGHT_MAX * 94 / 100 }; /* light from which clipping begins to count */

/* 0 to 256 as v goes from a to b. */
static inline int rf_ramp(int64_t v, int64_t a, int64_t b)
{
    return v >= b ? 256 : v <= a ? 0 : (int)(256 * (v - a) / (b - a));
}

/* The brightest channel of the pixel that lies at `at` of its planes. */
static inline int rf_brightest_at(const struct rf_light_q12 *light, ptrdiff_t at)
{
    int most = light->channel[0][at];

    most = light->channel[1][at] > most ? light->channel[1][at] : most;
    return light->channel[2][at] > most ? light->channel[2][at] : most;
}

#endif
