/* binomial16.c: smooths disparities by a binomial 3x3 mean. */
#include "kernels/kernels.h"

void RF_VEC(rf_binomial16)(uint16_t *restrict out, const uint16_t *const row[3], int n)
{
    const uint16_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const uint32_t left = (uint32_t)above[x - 1] + 2u * here[x - 1] + below[x - 1];
        const uint32_t own = (uint32_t)above[x] + 2u * here[x] + below[x];
        const uint32_t right = (uint32_t)above[x + 1] + 2u * here[x + 1] + below[x + 1];

        out[x] = (uint16_t)((left + 2 * own + right) >> 4);
    }
}
