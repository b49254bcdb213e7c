/* premultiplied_means.c: divides 32-bit sums of light, premultiplied by weights, by the sums of the
 * weights. */
#include "kernels/kernels.h"

void RF_VEC(rf_premultiplied_means)(uint16_t *restrict mean, const uint32_t *restrict sum,
                                    const uint32_t *restrict weight, int n)
{
    for (int i = 0; i < n; i++) {
        const float v = (float)(int32_t)sum[i] * 8192.0f / (float)(int32_t)weight[i] + 0.5f;

        mean[i] = (uint16_t)(int32_t)(v < 65520.0f ? v : 65520.0f);
    }
}
