/* median3.c: the depth upsampler: a weighted median of 3 x 3 disparities that leans to the near. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"
#include "kernels/sort_network.h"

/* Keys are disparities whose lowest bit says whether they are sure. */
static inline uint16_t key(uint16_t d, uint8_t sure)
{
    return (uint16_t)((d & ~1) | (sure & 1));
}

static uint16_t leaning(uint16_t v[9])
{
    int sures = 0, below, i = 8;

    for (int k = 0; k < RF_EXCHANGES9; k++) {
        uint16_t *a = &v[rf_exchange9[k][0]], *b = &v[rf_exchange9[k][1]];
        const uint16_t low = rf_least16(*a, *b), high = rf_most16(*a, *b);

        *a = low;
        *b = high;
    }
    for (int k = 0; k < 9; k++)
        sures += v[k] & 1;
    below = 45 + 15 * sures; /* the weights up to v[i], times 5 */
    for (; i > 0; i--) {
        below -= 5 + 15 * (v[i] & 1);
        if (below <= 27 + 9 * sures)
            break;
    }
    return (uint16_t)(v[i] & ~1);
}

void rf_median3_c(uint16_t *restrict out, const uint16_t *const row[3],
                  const uint8_t *const sure[3], int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t v[9];

        out[x] = row[1][x];
        if (sure[1][x])
            continue;
        for (int i = 0; i < 9; i++)
            v[i] = key(row[i / 3][x + i % 3 - 1], sure[i / 3][x + i % 3 - 1]);
        out[x] = leaning(v);
    }
}
