/* push_planes.h: the template of push, which reduces a level of the inpainting pyramid. */
#ifndef RF_KERNELS_PUSH_PLANES_H
#define RF_KERNELS_PUSH_PLANES_H

#include "kernels/kernels.h"

#include <assert.h>

/* The largest difference of two blurs of one layer. */
static inline uint16_t rf_push_apart(int16_t apart)
{
    return apart == INT16_MAX ? UINT16_MAX : (uint16_t)apart;
}

/* Whether a child counts: it is known, and not in front of what is `farthest`. */
static inline uint16_t rf_push_known(int16_t blur, int16_t farthest, int16_t apart)
{
    const uint16_t in_front = (uint16_t)((uint16_t)farthest - (uint16_t)blur);
    const uint16_t is_given = blur != RF_NO_BLUR ? 0xffff : 0;

    return is_given & (uint16_t)(in_front <= rf_push_apart(apart) ? 0xffff : 0);
}

static inline int16_t rf_push_farther(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

/* The first plane finds the blurs of the level, too. */
static RF_ALWAYS_INLINE void
rf_push_plane(uint16_t *restrict out, int16_t *restrict out_blur, const uint16_t *restrict upper,
              const uint16_t *restrict lower, const int16_t *restrict blur0,
              const int16_t *restrict blur1, int16_t apart, int n, const bool first)
{
    for (int x = 0; x < n; x++) {
        const int16_t farthest = rf_push_farther(rf_push_farther(blur0[2 * x], blur0[2 * x + 1]),
                                                 rf_push_farther(blur1[2 * x], blur1[2 * x + 1]));
        const uint16_t k0 = rf_push_known(blur0[2 * x], farthest, apart);
        const uint16_t k1 = rf_push_known(blur0[2 * x + 1], farthest, apart);
        const uint16_t k2 = rf_push_known(blur1[2 * x], farthest, apart);
        const uint16_t k3 = rf_push_known(blur1[2 * x + 1], farthest, apart);
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
            out_blur[x] = (int16_t)(farthest & ~RF_INPAINTED);
    }
}

#endif
