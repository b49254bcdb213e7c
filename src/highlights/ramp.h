/* ramp.h: what sets in gradually as light or blur grows. */
#ifndef RF_RAMP_H
#define RF_RAMP_H

#include <stdint.h>

/* 0 to 256 as v goes from a to b. */
static inline int rf_ramp(int64_t v, int64_t a, int64_t b)
{
    return v >= b ? 256 : v <= a ? 0 : (int)(256 * (v - a) / (b - a));
}

#endif
