/* weigh_vec.h: what weighing planes of R, G, B and of Y, U, V has in common. */
#ifndef RF_WEIGH_VEC_H
#define RF_WEIGH_VEC_H

#include <stdbool.h>

#include "kernels/kernels.h"
#include "simd/vec.h"

/* Weights come out of a table, one by one: of so many tiles' rows, before any is used, as a
 * vector of values that were just stored apart would wait for them. */
enum { RF_WEIGH_TILES = 16, RF_WEIGH_RUN = RF_WEIGH_TILES * (int)RF_TILE };

/* Of a run, what its weights go by: of the background only where it is not what is seen. */
struct rf_weigh_run {
    uint16_t near[RF_WEIGH_RUN], far[RF_WEIGH_RUN]; /* light, white at most */
    bool same[RF_WEIGH_TILES];
};

static inline void rf_look_up_weights(uint16_t *near_weight, uint16_t *far_weight,
                                      const struct rf_weigh_run *run,
                                      const uint16_t *light_weight, int tiles)
{
    for (int x = 0; x < tiles * RF_TILE; x++)
        near_weight[x] = light_weight[run->near[x]] >> 3;
    for (int i = 0; i < tiles; i++)
        for (int x = i * RF_TILE; !run->same[i] && x < (i + 1) * RF_TILE; x++)
            far_weight[x] = light_weight[run->far[x]] >> 3;
}

static inline vec_u16 rf_eight_times(vec_u16 weight)
{
    const vec_u16 two = vec_u16_add(weight, weight), four = vec_u16_add(two, two);

    return vec_u16_add(four, four);
}

#endif
