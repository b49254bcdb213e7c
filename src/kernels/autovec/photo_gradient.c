/* photo_gradient.c: the gradient of the channel of a photo that changes most. */
#include "kernels/kernels.h"

/* An eighth, towards 0. */
static RF_ALWAYS_INLINE int16_t eighth(int16_t v)
{
    return (int16_t)((int16_t)(v + (v < 0 ? 7 : 0)) >> 3);
}

void RF_VEC(rf_photo_gradient)(int16_t *restrict gx, int16_t *restrict gy,
                               const uint16_t *const row[3], int n)
{
    const uint16_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const int16_t right = eighth((int16_t)((above[x + 1] + 2 * here[x + 1] + below[x + 1]) -
                                               (above[x - 1] + 2 * here[x - 1] + below[x - 1])));
        const int16_t down = eighth((int16_t)((below[x - 1] + 2 * below[x] + below[x + 1]) -
                                              (above[x - 1] + 2 * above[x] + above[x + 1])));
        const int32_t own = right * right + down * down, was = gx[x] * gx[x] + gy[x] * gy[x];

        gx[x] = own > was ? right : gx[x];
        gy[x] = own > was ? down : gy[x];
    }
}
