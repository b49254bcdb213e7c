/* means.c: divides the sums of light over N rays by N. */
#include "kernels/kernels.h"

/* (4 sum + N / 2) / N by a multiplication; see rf_mean_scale(). */
static void means_by_scale(uint16_t *restrict mean, const uint32_t *restrict sum, uint32_t scale,
                           int n)
{
    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)(((uint64_t)sum[i] * scale + (UINT64_C(1) << 29)) >> 30);
}

/* Means by scale = 2^(30 - shift) need no 64-bit products. */
static void means_by_shift(uint16_t *restrict mean, const uint32_t *restrict sum, int shift, int n)
{
    const uint32_t half = UINT32_C(1) << (shift - 1);

    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)((sum[i] + half) >> shift);
}

void RF_VEC(rf_means)(uint16_t *restrict mean, const uint32_t *restrict sum, uint32_t scale, int n)
{
    if ((scale & (scale - 1)) == 0 && scale < 1u << 30)
        means_by_shift(mean, sum, 30 - __builtin_ctz(scale), n);
    else
        means_by_scale(mean, sum, scale, n);
}
