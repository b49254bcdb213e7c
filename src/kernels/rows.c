/* rows.c: loops over rows, written for the compiler's vectoriser.
 *
 * Compiled once as plain C and once for each instruction set, with RF_VEC_SET as its name: no
 * branch and no table look-up in the inner loops, conditions as masks, 16-bit lanes.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

static inline uint16_t max16(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t less(uint16_t a, uint16_t b) /* a - b, not below 0 */
{
    return (uint16_t)(a > b ? a - b : 0);
}

static void RF_VEC(rf_signed_blur)(int16_t *restrict blur, const uint16_t *restrict disparity,
                                   struct rf_focus focus, int n)
{
    const uint16_t df = focus.disparity, radius = focus.radius;

    for (int x = 0; x < n; x++) {
        const uint16_t d = disparity[x];
        const uint16_t near = (uint16_t)(d > df ? 0xffff : 0);
        const uint16_t distance = (uint16_t)((uint16_t)((uint16_t)(df - d) ^ near) - near);
        const uint16_t high = (uint16_t)(((uint32_t)distance * radius) >> 16);
        const uint16_t low = (uint16_t)(distance * (uint32_t)radius);
        const uint16_t r = (uint16_t)(high + (low >> 15)); /* half up, in 16-bit lanes */

        blur[x] = (int16_t)((uint16_t)(r ^ near) - near);
    }
}

static void spread(uint16_t *restrict out, const uint16_t *restrict in, int step, uint16_t fall,
                   int n)
{
    for (int x = 0; x < n; x++)
        out[x] = max16(in[x], less(max16(in[x - step], in[x + step]), fall));
}

static uint16_t *RF_VEC(rf_spread_row)(uint16_t *row, uint16_t *spare, int reach, int n)
{
    for (int step = 1, sum = 0; sum < reach; sum += step, step *= 2) {
        uint16_t *const last = row;

        memset(row - step, 0, (size_t)step * 2);
        memset(row + n, 0, (size_t)step * 2);
        spread(spare, row, step, (uint16_t)(step * RF_CONE_STEP), n);
        row = spare;
        spare = last;
    }
    return row;
}

static void RF_VEC(rf_dilate_from)(uint16_t *restrict row, const uint16_t *restrict before, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t slant = less(max16(before[x - 1], before[x + 1]), RF_CONE_DIAGONAL);

        row[x] = max16(row[x], max16(slant, less(before[x], RF_CONE_STEP)));
    }
}

static void RF_VEC(rf_mark)(int16_t *restrict behind, const int16_t *restrict blur,
                            const uint16_t *restrict dilated, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t s = (uint16_t)((uint16_t)blur[x] ^ 0x8000);
        const uint16_t foreground = (uint16_t)(less(dilated[x], s) > 128 ? 0xffff : 0);

        behind[x] = (int16_t)((foreground & 0x8000) | (~foreground & (uint16_t)blur[x]));
    }
}

/* (4 sum + N / 2) / N by a multiplication; see rf_mean_scale(). */
static void means_by_scale(uint16_t *restrict mean, const uint32_t *restrict sum, uint32_t scale,
                           int n)
{
    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)(((uint64_t)sum[i] * scale + (UINT64_C(1) << 29)) >> 30);
}

/* The same for scale = 2^(30 - shift), without 64-bit products. */
static void means_by_shift(uint16_t *restrict mean, const uint32_t *restrict sum, int shift, int n)
{
    const uint32_t half = UINT32_C(1) << (shift - 1);

    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)((sum[i] + half) >> shift);
}

static void RF_VEC(rf_means)(uint16_t *restrict mean, const uint32_t *restrict sum, uint32_t scale,
                             int n)
{
    if ((scale & (scale - 1)) == 0 && scale < 1u << 30)
        means_by_shift(mean, sum, 30 - __builtin_ctz(scale), n);
    else
        means_by_scale(mean, sum, scale, n);
}

static void RF_VEC(rf_at_most)(uint16_t *restrict value, uint16_t most, int n)
{
    for (int i = 0; i < n; i++)
        value[i] = value[i] < most ? value[i] : most;
}

void RF_VEC(rf_rows_use)(struct rf_kernels *kernels)
{
    kernels->signed_blur = RF_VEC(rf_signed_blur);
    kernels->spread_row = RF_VEC(rf_spread_row);
    kernels->dilate_from = RF_VEC(rf_dilate_from);
    kernels->mark = RF_VEC(rf_mark);
    kernels->means = RF_VEC(rf_means);
    kernels->at_most = RF_VEC(rf_at_most);
}
