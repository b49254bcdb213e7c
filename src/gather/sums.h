/* sums.h: how much light 16-bit sums and means can hold, as highlights are brighter than white. */
#ifndef RF_SUMS_H
#define RF_SUMS_H

#include "highlights/highlights.h"

#include <assert.h>
#include "tiles/tiles.h"

/* How many values of the light that reaches a tile a 16-bit sum holds: 16 of white (4095), 8 of
 * twice white. */
static inline int rf_steps_of(const struct rf_tile_plan *plan)
{
    return plan->brightest > 65535 / 16 ? 65535 / plan->brightest : 16;
}

/* The largest mean. Means, Q14 in 16 bits, are at most 4 times white: they are written as white in
 * any case. */
enum { RF_MOST_MEAN = RF_PLAIN_GAIN * RF_LIGHT_MAX };

static_assert(4 * RF_MOST_MEAN <= UINT16_MAX, "the largest mean in Q14");
static_assert(RF_MOST_GAIN * RF_LIGHT_MAX <= UINT16_MAX, "the brightest light, of one ray");

/* Whether means of a tile could exceed that. */
static inline bool rf_exceeds_means(const struct rf_tile_plan *plan)
{
    return plan->brightest > RF_MOST_MEAN;
}

/* Clamps n sums over `rays` rays to those of the largest mean. */
static inline void rf_clamp_sums(uint32_t *sum, uint32_t rays, int n)
{
    const uint32_t most = RF_MOST_MEAN * rays;

    for (int i = 0; i < n; i++)
        sum[i] = sum[i] < most ? sum[i] : most;
}

#endif
