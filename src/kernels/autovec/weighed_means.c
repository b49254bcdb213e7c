/* weighed_means.c: means of 32-bit sums of light that was multiplied by its weight before. */
#include "kernels/kernels.h"

void RF_VEC(rf_weighed_means)(uint16_t *restrict mean, const uint32_t *restrict sum,
                              const uint32_t *restrict weight, int n)
{
    for (int i = 0; i < n; i++) {
        const float v = (float)(int32_t)sum[i] * 8192.0f / (float)(int32_t)weight[i] + 0.5f;

        mean[i] = (uint16_t)(int32_t)(v < 65520.0f ? v : 65520.0f);
    }
}
