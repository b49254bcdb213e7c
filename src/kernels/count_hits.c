/* count_hits.c: counts which pixels the rays of a search of one test see, of one row of a tile. */
#include "kernels/kernels.h"

void rf_count_hits_c(uint16_t (*count)[RF_TILE], uint8_t *touched, const int16_t *blur,
                     const struct rf_counted_rays *rays)
{
    for (int n = 0; n < rays->rays; n++) {
        const int within = rays->within[n];

        for (int i = 0; i < RF_TILE; i++) {
            const int guess = blur[i + rays->start[n]];
            const int x = (rays->u[n] * guess + (1 << 22)) >> 23;
            const int y = (rays->v[n] * guess + (1 << 22)) >> 23;
            const int seen = blur[i + x + y * RF_COUNT_ROW];
            const bool hit = (seen - guess <= within && guess - seen <= within) || seen <= blur[i];
            const int number = hit ? rf_count_number(x, y) : rf_count_number(0, 0);

            count[number][i] = (uint16_t)(count[number][i] + rays->times[n]);
            touched[number] = 1;
        }
    }
}
