/* yuv.c: loops over rows of luma and of chroma, written as those of rows.c. */
#include "kernels/cubic.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

static inline uint16_t size(int16_t s)
{
    return (uint16_t)(s < 0 ? -s : s);
}

static inline int16_t sharper(int16_t a, int16_t b)
{
    return size(a) <= size(b) ? a : b;
}

static void RF_VEC(rf_sharpest4)(int16_t *restrict out, const int16_t *restrict upper,
                                 const int16_t *restrict lower, int n)
{
    for (int x = 0; upper == lower && x < n; x++)
        out[2 * x] = out[2 * x + 1] = sharper(upper[2 * x], upper[2 * x + 1]);
    for (int x = 0; upper != lower && x < n; x++) {
        const int16_t s = sharper(sharper(upper[2 * x], upper[2 * x + 1]),
                                  sharper(lower[2 * x], lower[2 * x + 1]));

        out[2 * x] = s;
        out[2 * x + 1] = s;
    }
}

static inline uint16_t known(int16_t blur)
{
    return (uint16_t)(blur != RF_NO_BLUR ? 0xffff : 0);
}

static inline int16_t farther(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

static void RF_VEC(rf_push1)(uint16_t *restrict out, int16_t *restrict out_blur,
                             const uint16_t *restrict upper, const uint16_t *restrict lower,
                             const int16_t *restrict blur0, const int16_t *restrict blur1, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t k0 = known(blur0[2 * x]), k1 = known(blur0[2 * x + 1]);
        const uint16_t k2 = known(blur1[2 * x]), k3 = known(blur1[2 * x + 1]);
        const uint16_t count = (uint16_t) - (uint16_t)(k0 + k1 + k2 + k3);
        const uint16_t sum = (uint16_t)((upper[2 * x] & k0) + (upper[2 * x + 1] & k1) +
                                        (lower[2 * x] & k2) + (lower[2 * x + 1] & k3));
        const uint16_t half = (uint16_t)((uint16_t)(sum + 1) >> 1);
        /* x / 3 as in arithmetic.md */
        const uint16_t third =
            (uint16_t)((uint16_t)(((uint32_t)(uint16_t)(sum + 1) * 43691) >> 16) >> 1);
        const uint16_t quarter = (uint16_t)((uint16_t)(sum + 2) >> 2);

        out[x] = count == 4 ? quarter : count == 3 ? third : count == 2 ? half : sum;
        out_blur[x] = farther(farther(blur0[2 * x], blur0[2 * x + 1]),
                              farther(blur1[2 * x], blur1[2 * x + 1]));
    }
}

static void RF_VEC(rf_split2)(uint16_t *restrict first, uint16_t *restrict second,
                              const uint16_t *upper, const uint16_t *lower, int n)
{
    for (int x = 0; x < n; x++) {
        first[x] = (uint16_t)((upper[2 * x] + lower[2 * x] + 1) >> 1);
        second[x] = (uint16_t)((upper[2 * x + 1] + lower[2 * x + 1] + 1) >> 1);
    }
}

static void RF_VEC(rf_join2)(uint16_t *restrict out, const uint16_t *restrict first,
                             const uint16_t *restrict second, int n)
{
    for (int x = 0; x < n; x++) {
        out[2 * x] = first[x];
        out[2 * x + 1] = second[x];
    }
}

static void RF_VEC(rf_keep2)(uint16_t *restrict out, const uint16_t *restrict own,
                             const int16_t *restrict blur, const int16_t *restrict behind, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t known =
            (uint16_t) - ((blur[2 * x] == behind[2 * x]) | (blur[2 * x + 1] == behind[2 * x + 1]));

        out[2 * x] = (uint16_t)((own[2 * x] & known) | (out[2 * x] & ~known));
        out[2 * x + 1] = (uint16_t)((own[2 * x + 1] & known) | (out[2 * x + 1] & ~known));
    }
}

/* The cubic through rows 0 2 5 7 at the others, shares in Q14; see light.c. */
static void RF_VEC(rf_between_chroma)(uint16_t *restrict mean, const uint16_t *restrict computed)
{
    enum { ROWS = 8 };
    static const int8_t before[ROWS] = {0, 0, 1, 1, 1, 2, 2, 2};
    static const int16_t share[ROWS][4] = {{16384, 0, 0, 0},
                                           {5617, 13108, -3277, 936},
                                           {0, 16384, 0, 0},
                                           {-1872, 13107, 6553, -1404},
                                           {-1404, 6553, 13107, -1872},
                                           {0, 0, 16384, 0},
                                           {936, -3277, 13108, 5617},
                                           {0, 0, 0, 16384}};

    for (int y = 0; y < ROWS; y++)
        rf_cubic_row(mean + y * RF_TILE, computed, computed + before[y] * RF_TILE, share[y]);
}

/* floor((u s + 2^(22 + shift)) / 2^(23 + shift)), by the high half of the product. */
static inline int16_t rounded(int16_t u, int16_t blur, int shift)
{
    return (int16_t)((int16_t)((int16_t)(u * blur >> 16) + (64 << shift)) >> (7 + shift));
}

static void RF_VEC(rf_aim_chroma)(int32_t *restrict offset, int32_t *restrict pixel,
                                  const int16_t *restrict u, const int16_t *restrict v, int blur,
                                  int down, int32_t stride, int n)
{
    const int16_t s = (int16_t)blur;

    for (int i = 0; i < n; i++) {
        const int32_t x = 2 * rounded(u[i], s, 1), y = rounded(v[i], s, down) * stride;

        offset[i] = x + y;
        pixel[i] = x + y * (1 << down);
    }
}

void RF_VEC(rf_yuv_use)(struct rf_kernels *kernels)
{
    kernels->aim_chroma = RF_VEC(rf_aim_chroma);
    kernels->sharpest4 = RF_VEC(rf_sharpest4);
    kernels->push1 = RF_VEC(rf_push1);
    kernels->split2 = RF_VEC(rf_split2);
    kernels->join2 = RF_VEC(rf_join2);
    kernels->keep2 = RF_VEC(rf_keep2);
    kernels->between_chroma = RF_VEC(rf_between_chroma);
    RF_VEC(rf_yuv_codes_use)(kernels);
}
