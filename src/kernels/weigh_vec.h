/* weigh_vec.h: what weighing planes of R, G, B and of Y, U, V has in common. */
#ifndef RF_WEIGH_VEC_H
#define RF_WEIGH_VEC_H

#include <stdbool.h>

#include "kernels/kernels.h"
#include "simd/vec.h"

/* Weights come out of a table, one by one: of so many tiles' rows, before any is used, as a
 * vector of values that were just stored apart would wait for them. */
enum { RF_WEIGH_TILES = 16, RF_WEIGH_RUN = RF_WEIGH_TILES * (int)RF_TILE };

/* Of a run, what its weights go by, light, white at most, and then they; of the background only
 * where it is not what is seen. */
struct rf_weigh_run {
    uint16_t near[RF_WEIGH_RUN], far[RF_WEIGH_RUN];
    bool same[RF_WEIGH_TILES];
};

static inline void rf_look_up_tile(uint16_t *restrict v, const uint16_t *restrict light_weight)
{
#pragma GCC unroll 16
    for (int x = 0; x < RF_TILE; x++)
        v[x] = light_weight[v[x]];
}

static inline void rf_look_up_weights(struct rf_weigh_run *run, const uint16_t *light_weight,
                                      int tiles)
{
    for (int i = 0; i < tiles; i++) {
        rf_look_up_tile(run->near + i * RF_TILE, light_weight);
        if (!run->same[i])
            rf_look_up_tile(run->far + i * RF_TILE, light_weight);
    }
}

/* A weight in Q15 to Q12, and that in Q15 again. */
static inline vec_u16 rf_eighth(vec_u16 weight)
{
    return vec_u16_half(vec_u16_half(vec_u16_half(weight)));
}

static inline vec_u16 rf_whole_eighths(vec_u16 weight)
{
    return vec_u16_without(weight, vec_u16_set(7));
}

static inline vec_u16 rf_eight_times(vec_u16 weight)
{
    const vec_u16 two = vec_u16_add(weight, weight), four = vec_u16_add(two, two);

    return vec_u16_add(four, four);
}

#endif
