/* map_slope.c: how steep a map of disparities is. */
#include "kernels/kernels.h"

#include <math.h>

void RF_VEC(rf_map_slope)(uint16_t *restrict slope, const uint16_t *const row[3], int n)
{
    const uint16_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const int32_t right = (above[x + 1] + 2 * here[x + 1] + below[x + 1]) -
                              (above[x - 1] + 2 * here[x - 1] + below[x - 1]);
        const int32_t down = (below[x - 1] + 2 * below[x] + below[x + 1]) -
                             (above[x - 1] + 2 * above[x] + above[x + 1]);
        const float across = (float)right, along = (float)down;

        slope[x] = (uint16_t)(int32_t)(sqrtf(across * across + along * along) / 8);
    }
}
