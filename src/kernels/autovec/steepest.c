/* steepest.c: which neighbour of a pixel is greatest and which is least. */
#include "kernels/kernels.h"

void RF_VEC(rf_steepest)(uint8_t *restrict out, const uint16_t *const row[3], int n)
{
    const uint16_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const uint16_t around[8] = {here[x + 1],  here[x - 1],  below[x],     above[x],
                                    below[x + 1], above[x + 1], below[x - 1], above[x - 1]};
        uint16_t most = here[x], least = here[x], rise = RF_NO_DIRECTION, fall = RF_NO_DIRECTION;

#pragma GCC unroll 8
        for (int k = 0; k < 8; k++) {
            rise = (uint16_t)(around[k] > most ? k : rise);
            fall = (uint16_t)(around[k] < least ? k : fall);
            most = around[k] > most ? around[k] : most;
            least = around[k] < least ? around[k] : least;
        }
        out[x] = (uint8_t)(rise + 16 * fall);
    }
}
