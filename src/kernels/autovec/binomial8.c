/* binomial8.c: smooths codes by a binomial 3x3 mean. */
#include "kernels/kernels.h"

void RF_VEC(rf_binomial8)(uint16_t *restrict out, const uint8_t *const row[3], int n)
{
    const uint8_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const uint16_t left = (uint16_t)(above[x - 1] + 2 * here[x - 1] + below[x - 1]);
        const uint16_t own = (uint16_t)(above[x] + 2 * here[x] + below[x]);
        const uint16_t right = (uint16_t)(above[x + 1] + 2 * here[x + 1] + below[x + 1]);

        out[x] = (uint16_t)(left + 2 * own + right);
    }
}
