/* blend4.c: the depth upsampler: computes the weighted mean of four rows of samples. */
#include "kernels/kernels.h"

void RF_VEC(rf_blend4)(uint16_t *restrict out, const uint16_t *const row[RF_TAPS],
                       const int16_t share[RF_TAPS], int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    const uint32_t sa = (uint16_t)share[0], sb = (uint16_t)share[1];
    const uint32_t sc = (uint16_t)share[2], sd = (uint16_t)share[3];

    for (int x = 0; x < n; x++) {
        const uint32_t sum = a[x] * sa + b[x] * sb + c[x] * sc + d[x] * sd;

        out[x] = (uint16_t)((sum + (1 << 14)) >> 15);
    }
}
