/* transpose16.c: the depth upsampler: transposes rows of 16-bit values to columns that lie end to
 * end. */
#include "kernels/kernels.h"

void RF_VEC(rf_transpose16)(uint16_t out[RF_AROUND * RF_TURNED],
                            const uint16_t *const row[RF_AROUND])
{
    const uint16_t *restrict a = row[0], *restrict b = row[1], *restrict c = row[2];
    const uint16_t *restrict d = row[3], *restrict e = row[4], *restrict f = row[5];
    const uint16_t *restrict g = row[6], *restrict h = row[7];

    for (int x = 0; x < RF_TURNED; x++) {
        uint16_t *restrict to = out + RF_AROUND * x;

        to[0] = a[x], to[1] = b[x], to[2] = c[x], to[3] = d[x];
        to[4] = e[x], to[5] = f[x], to[6] = g[x], to[7] = h[x];
    }
}
