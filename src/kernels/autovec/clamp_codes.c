/* clamp_codes.c: clamps the smoothed codes of a disparity map to an interval about the original
 * ones. */
#include "kernels/kernels.h"

void RF_VEC(rf_clamp_codes)(uint16_t *restrict code, const uint16_t *restrict smooth, uint16_t most,
                            int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t own = code[x];
        const uint16_t low = (uint16_t)(own > most ? own - most : 0);
        const uint16_t high = (uint16_t)(own < 65535 - most ? own + most : 65535);
        const uint16_t up = smooth[x] > low ? smooth[x] : low;

        code[x] = up < high ? up : high;
    }
}
