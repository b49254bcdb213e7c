/* sums.h: what 16-bit sums of light and means can hold, where highlights are brighter than
 * white. */
#ifndef RF_SUMS_H
#define RF_SUMS_H

#include "highlights/highlights.h"
#include "tiles/tiles.h"

/* How many values of what reaches a tile a 16-bit sum holds. */
static inline int rf_steps_of(const struct rf_tile_plan *plan)
{
    return plan->brightest > 65535 / 16 ? 65535 / plan->brightest : 16;
}

/* Means, Q14 in 16 bits, are at most 4 times white: it is all white in the end. */
enum { RF_MOST_MEAN = RF_PLAIN_GAIN * RF_LIGHT_MAX };

/* Whether they could be more. */
static inline bool rf_exceeds_means(const struct rf_tile_plan *plan)
{
    return plan->brightest > RF_MOST_MEAN;
}

/* n sums of so many rays to what means can be. */
static inline void rf_limit_sums(uint32_t *sum, uint32_t rays, int n)
{
    const uint32_t most = RF_MOST_MEAN * rays;

    for (int i = 0; i < n; i++)
        sum[i] = sum[i] < most ? sum[i] : most;
}

#endif
