/* half_chords.c: computes half the width of a disc in each row of a tile. */
#include "kernels/kernels.h"

#include <math.h>

void RF_VEC(rf_half_chords)(int16_t *restrict half, int radius, int first, int tall, int unit)
{
    const float r = (float)radius * (1 / 256.0f), square = r * r;
    const float scale = (float)(32 >> unit) / (float)tall;
    float sum[RF_TILE];

    for (int y = 0; y < RF_TILE; y++)
        sum[y] = 0.5f;
    for (int k = 0; k < 2 * tall; k++) {
        const float from = (float)(first - tall + k) * 0.5f + 0.25f;

#pragma GCC unroll 1
        for (int y = 0; y < RF_TILE; y++) {
            const float d = from + (float)y, rest = square - d * d;

            sum[y] += sqrtf(rest > 0 ? rest : 0) * scale;
        }
    }
    for (int y = 0; y < RF_TILE; y++)
        half[y] = (int16_t)sum[y];
}
