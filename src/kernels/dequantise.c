/* dequantise.c: rows of a disparity map whose few codes are to become slopes again.
 *
 * Plain C for the compiler's vectoriser, compiled once for each instruction set: 16-bit lanes,
 * conditions as masks.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* What two opposite neighbours differ from their pixel in sum, or 0 if one lies outside low ..
 * high: a difference too large to be a rounding error. What is kept is below 2^15, so that it is
 * exact modulo 2^16. */
static inline int16_t bend(uint16_t a, uint16_t b, uint16_t own, uint16_t low, uint16_t high)
{
    const uint16_t most = a > b ? a : b, least = a > b ? b : a;
    const uint16_t near = (uint16_t)(most <= high ? 0xffff : 0);
    const uint16_t far = (uint16_t)(least >= low ? 0xffff : 0);

    return (int16_t)((uint16_t)(a + b - 2 * own) & near & far);
}

static void RF_VEC(rf_smooth_codes)(uint16_t *restrict out, const uint16_t *const row[3], int apart,
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

static void RF_VEC(rf_clamp_codes)(uint16_t *restrict code, const uint16_t *restrict smooth,
                                   uint16_t most, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t own = code[x];
        const uint16_t low = (uint16_t)(own > most ? own - most : 0);
        const uint16_t high = (uint16_t)(own < 65535 - most ? own + most : 65535);
        const uint16_t up = smooth[x] > low ? smooth[x] : low;

        code[x] = up < high ? up : high;
    }
}

void RF_VEC(rf_dequantise_use)(struct rf_kernels *kernels)
{
    kernels->smooth_codes = RF_VEC(rf_smooth_codes);
    kernels->clamp_codes = RF_VEC(rf_clamp_codes);
}
