/* push_planes.h: the template of push, which reduces a level of the inpainting pyramid. */
#ifndef RF_KERNELS_PUSH_PLANES_H
#define RF_KERNELS_PUSH_PLANES_H

#include "kernels/kernels.h"

#include <assert.h>

static inline uint16_t rf_push_known(int16_t blur)
{
    return (uint16_t)(blur != RF_NO_BLUR ? 0xffff : 0);
}

static inline int16_t rf_push_farther(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

/* The first plane finds the blurs of the level, too. */
static RF_ALWAYS_INLINE void rf_push_plane(uint16_t *restrict out, int16_t *restrict out_blur,
                                           const uint16_t *restrict upper,
                                           const uint16_t *restrict lower,
                                           const int16_t *restrict blur0,
                                           const int16_t *restrict blur1, int n, const bool first)
{
    for (int x = 0; x < n; x++) {
        const uint16_t k0 = rf_push_known(blur0[2 * x]), k1 = rf_push_known(blur0[2 * x + 1]);
        const uint16_t k2 = rf_push_known(blur1[2 * x]), k3 = rf_push_known(blur1[2 * x + 1]);
        const uint16_t count = (uint16_t) - (uint16_t)(k0 + k1 + k2 + k3);
        const uint16_t sum = (uint16_t)((upper[2 * x] & k0) + (upper[2 * x + 1] & k1) +
                                        (lower[2 * x] & k2) + (lower[2 * x + 1] & k3));
        const uint16_t half = (uint16_t)((uint16_t)(sum + 1) >> 1);
        static_assert(3 * 43691 == (1 << 17) + 1, "so the third is exact below 2^16");
        const uint16_t third =
            (uint16_t)((uint16_t)(((uint32_t)(uint16_t)(sum + 1) * 43691) >> 16) >> 1);
        const uint16_t quarter = (uint16_t)((uint16_t)(sum + 2) >> 2);

        out[x] = count == 4 ? quarter : count == 3 ? third : count == 2 ? half : sum;
        if (first)
            out_blur[x] = rf_push_farther(rf_push_farther(blur0[2 * x], blur0[2 * x + 1]),
                                          rf_push_farther(blur1[2 * x], blur1[2 * x + 1]));
    }
}

#endif
