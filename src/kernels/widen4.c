/* widen4.c: the depth upsampler: computes pixels of a row as weighted means of four samples. */
#include "kernels/kernels.h"

static inline uint16_t widen(const uint16_t *d, const int16_t *share)
{
    int32_t sum = 1 << 14;

    for (int k = 0; k < RF_TAPS; k++)
        sum += (d[k] - 32768) * share[k];
    return (uint16_t)((sum >> 15) + 32768);
}

void rf_widen4_c(uint16_t *restrict out, const uint16_t *restrict in,
                 const struct rf_taps *restrict taps, int n)
{
    for (int x = 0; x < n; x++)
        out[x] = widen(in + taps[x].first, taps[x].share);
}
