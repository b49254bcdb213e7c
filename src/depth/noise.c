/* noise.c: the noise of a disparity map is measured, and smoothed away within surfaces. */
#include "depth/noise.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    LEAST = 262,         /* 0.4 %: less is left as it is */
    BIN = 16,            /* codes of a bin of the histogram */
    BINS = 2048,         /* more is as good as the last of them */
    LOOKED_AT = 1 << 16, /* pixels, about */
    FEWEST = 256,        /* pixels that tell anything */
    ALIKE_Q1 = 7,        /* neighbours within 3.5 deviations are of the same surface */
    MOST_MOVED = 2,      /* deviations */
};

/* How far a pixel lies from the line through its neighbours, across or down: the lesser. */
static int off_line(const uint16_t *row, ptrdiff_t stride, int x)
{
    const int across = abs(2 * row[x] - row[x - 1] - row[x + 1]);
    const int down = abs(2 * row[x] - row[x - stride] - row[x + stride]);

    return rf_smaller(across, down);
}

/* The value that `share` of `count` are below, in 1/100. */
static int percentile(const uint32_t *histogram, int64_t count, int share)
{
    int64_t sum = 0;
    int bin = 0;

    while (bin < BINS - 1 && (sum += histogram[bin]) * 100 < count * share)
        bin++;
    return bin * BIN;
}

int rf_noise_of(struct rf_disparity_q16 map, int width, int height, int step)
{
    const int64_t pixels = (int64_t)width * height;
    const int every = (int)(pixels / LOOKED_AT) + 1;
    uint32_t histogram[BINS];
    int64_t count = 0;
    int quarter, three_quarters, deviation;

    memset(histogram, 0, sizeof histogram);
    for (int y = 1; y < height - 1; y += every)
        for (int x = 1; x < width - 1; x++, count++)
            histogram[rf_smaller(off_line(map.at + y * map.stride, map.stride, x) / BIN,
                                 BINS - 1)]++;
    if (count < FEWEST)
        return 0;
    quarter = percentile(histogram, count, 25);
    deviation = quarter * 50 / 19;
    three_quarters = percentile(histogram, count, 75);
    /* Noise is everywhere alike; the edges of a forest of depths are not. */
    if (deviation < LEAST || three_quarters > 8 * quarter || three_quarters <= step)
        return 0;
    return deviation;
}

/* ----- smoothing ----- */

struct shift {
    struct rf_disparity_q16 map;
    int width, by; /* < 0: to the right */
};

static void shift_row(void *context, int y, int worker)
{
    const struct shift *shift = context;
    uint16_t *row = shift->map.at + y * shift->map.stride;

    (void)worker;
    for (int x = 0; x < shift->width; x++)
        row[x] = (uint16_t)(shift->by < 0 ? row[x] >> -shift->by : row[x] << shift->by);
}

void rf_denoise(const struct rf_kernels *kernels, struct rf_disparity_q16 map,
                const struct rf_disparity_q16 spare[2], int width, int height, int deviation,
                struct rf_pool *pool)
{
    /* From far to near, and again within half of that, for what is left. */
    static const struct {
        int apart, share;
    } passes[] = {{8, 2}, {4, 2}, {2, 2}, {1, 2}, {2, 1}, {1, 1}};
    enum { PASSES = sizeof passes / sizeof *passes };
    struct rf_smooth_pass pass[PASSES];
    struct shift shift = {.map = map, .width = width};
    struct rf_smoother smoother = {.kernels = kernels,
                                   .code = map,
                                   .spare = {spare[0], spare[1]},
                                   .width = width,
                                   .height = height,
                                   .pass = pass,
                                   .passes = PASSES};
    int alike = deviation * ALIKE_Q1 / 2, moved = deviation * MOST_MOVED;

    /* Much noise hides the last bits anyway. */
    for (; alike > RF_MOST_SMOOTHED; alike /= 2, moved /= 2)
        shift.by--;
    for (int i = 0; i < PASSES; i++)
        pass[i] = (struct rf_smooth_pass){passes[i].apart, (uint16_t)(alike * passes[i].share / 2)};
    smoother.most_moved = (uint16_t)rf_smaller(moved, UINT16_MAX);
    if (shift.by)
        rf_pool_run(pool, shift_row, &shift, height);
    rf_smooth(&smoother, pool);
    shift.by = -shift.by;
    if (shift.by)
        rf_pool_run(pool, shift_row, &shift, height);
}
