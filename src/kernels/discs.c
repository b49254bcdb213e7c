/* discs.c: how wide a disc is in each row, plain C for the vectoriser. */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <math.h>

static void RF_VEC(rf_half_chords)(int16_t *restrict half, int radius, int first)
{
    const float r = (float)radius * (1 / 256.0f), square = r * r;

#pragma GCC unroll 1
    for (int y = 0; y < RF_TILE; y++) {
        const float d = (float)(first + y), above = d - 0.25f, below = d + 0.25f;
        const float a = square - above * above, b = square - below * below;

        half[y] =
            (int16_t)(sqrtf(a > 0 ? a : 0) * 32 + sqrtf(b > 0 ? b : 0) * 32 + 0.5f);
    }
}

void RF_VEC(rf_discs_use)(struct rf_kernels *kernels)
{
    kernels->half_chords = RF_VEC(rf_half_chords);
}
