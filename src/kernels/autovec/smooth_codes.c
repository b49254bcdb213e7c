/* smooth_codes.c: a 3x3 mean of the codes of a disparity map, up to its edges. */
#include "kernels/kernels.h"

/* How much two opposite neighbours differ from their pixel in sum, or 0 if one lies outside low ..
 * high: a difference too large to be a rounding error. What is kept is below 2^15, so that it is
 * exact modulo 2^16. */
static inline int16_t bend(uint16_t a, uint16_t b, uint16_t own, uint16_t low, uint16_t high)
{
    const uint16_t most = a > b ? a : b, least = a > b ? b : a;
    const uint16_t near = (uint16_t)(most <= high ? 0xffff : 0);
    const uint16_t far = (uint16_t)(least >= low ? 0xffff : 0);

    return (int16_t)((uint16_t)(a + b - 2 * own) & near & far);
}

void RF_VEC(rf_smooth_codes)(uint16_t *restrict out, const uint16_t *const row[3], int apart,
                             uint16_t most, int n)
{
    const uint16_t *restrict above = row[0], *restrict here = row[1], *restrict below = row[2];

    for (int x = 0; x < n; x++) {
        const uint16_t own = here[x];
        const uint16_t low = (uint16_t)(own > most ? own - most : 0);
        const uint16_t high = (uint16_t)(own < 65535 - most ? own + most : 65535);
        const int16_t slanted = (int16_t)(bend(above[x - apart], below[x + apart], own, low, high) +
                                          bend(above[x + apart], below[x - apart], own, low, high));
        const int16_t straight = (int16_t)(bend(above[x], below[x], own, low, high) +
                                           bend(here[x - apart], here[x + apart], own, low, high));

        out[x] = (uint16_t)(own + ((int16_t)(slanted + 2 * straight + 8) >> 4));
    }
}
