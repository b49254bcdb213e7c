/* upsample.c: brings a disparity map to the size of the photo: means, and the order of steps. */
#include "depth/upsample.h"
#include "support/compare.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum {
    PAD = RF_UPSAMPLE_PAD,
    SPAN = 4, /* rows of samples of a work item */
    BLOCK = RF_UPSAMPLE_BLOCK,
    STRIP = 16, /* bands of a strip */
};

/* Rows of pixels of a strip and of the two bands before it, and rows of samples of a strip. A row
 * of samples is between as many rows of pixels as the photo has for it, or one more. */
static int kept_rows(const struct rf_upsampler *up)
{
    const int64_t most = (STRIP + 2) * SPAN * (int64_t)(up->photo->height / up->rows + 1);

    return up->in_strips && most < up->photo->height ? (int)most : up->photo->height;
}

static int wide_rows(const struct rf_upsampler *up)
{
    const int most = STRIP * SPAN + RF_TAPS;

    return up->in_strips && most < up->rows ? most : up->rows;
}

void rf_upsampler_lay_out(struct rf_upsampler *up, struct rf_arena *arena)
{
    const uint64_t width = (uint64_t)up->photo->width, height = (uint64_t)up->photo->height;
    const uint64_t columns = (uint64_t)up->columns, rows = (uint64_t)up->rows;
    const uint64_t kept = (uint64_t)kept_rows(up);

    up->coarse.stride = up->columns + 4;
    up->coarse.at = rf_arena_take(arena, (columns + 4) * (rows + 4), 2);
    up->wide.stride = up->photo->width;
    up->wide.at = rf_arena_take(arena, width * (uint64_t)wide_rows(up), 2);
    up->settled.stride = up->photo->width;
    up->settled.at = rf_arena_take(arena, width * kept, 2);
    up->across = rf_arena_take(arena, width, sizeof *up->across);
    up->down = rf_arena_take(arena, height, sizeof *up->down);
    up->span = rf_arena_take(arena, columns + 2, sizeof *up->span);
    up->colour.stride = up->trust.stride = up->coarse.stride;
    for (int c = 0; c < 3; c++)
        up->colour.channel[c] = rf_arena_take(arena, (columns + 4) * (rows + 4), 1);
    if (up->confidence)
        up->trust.at = rf_arena_take(arena, (columns + 4) * (rows + 4), 1);
    up->sure.stride = up->photo->width;
    up->sure.at = rf_arena_take(arena, width * kept, 1);
    up->unsure.stride = rf_upsample_blocks(up->photo->width) + 1;
    up->unsure.at = rf_arena_take(arena, (uint64_t)up->unsure.stride * kept, 2);
    if (up->in_strips) {
        up->spare.stride = up->columns;
        up->spare.at = rf_arena_take(arena, columns * rows, 2);
    }
    if (arena->base) {
        up->coarse.at += 2 * up->coarse.stride + 2;
        for (int c = 0; c < 3; c++)
            up->colour.channel[c] += 2 * up->colour.stride + 2;
        if (up->confidence)
            up->trust.at += 2 * up->trust.stride + 2;
    }
}

/* Cubic B-spline, for means: it smooths noise, and keeps slopes. t in Q8, result in Q24
 * / 6: four of them, one apart, add up to 6 << 24. */
static int mean_weight(int t)
{
    const int a = abs(t), left = 512 - a;

    if (a >= 512)
        return 0;
    return a >= 256 ? left * left * left : 4 * (1 << 24) - 6 * 256 * a * a + 3 * a * a * a;
}

/* 0.465 (1 - (t / 2)^2)^2 in Q16 for what is expected before the photo is looked at:
 * four of them add up to less than 1. t in Q8. */
#define FALL(t)     (65536 - (t) * (t) / 4)
#define NEARNESS(t) ((int64_t)FALL(t) * FALL(t) / 65536 * 30474 / 65536)
static_assert(2 * (NEARNESS(128) + NEARNESS(384)) < 65536, "the sum is greatest half way between");
static uint16_t nearness(int t)
{
    const int64_t fall = 65536 - t * t / 4;

    return (uint16_t)(fall <= 0 ? 0 : (fall * fall >> 16) * 30474 >> 16);
}

/* Pixel centres at (x + 1/2) / size of both rasters. Q8. */
static int64_t position(int x, int size, int samples)
{
    return ((2 * (int64_t)x + 1) * samples * 128) / size - 128;
}

static struct rf_taps taps_at(int x, int size, int samples)
{
    const int64_t at = position(x, size, samples);
    struct rf_taps taps = {.first = (int32_t)((at + 256) >> 8) - 2};
    const int off = (int)(at - (int64_t)taps.first * 256); /* 256 to 511 */
    int left = 32768, greatest = 0;

    taps.middle = (int16_t)((off - 256 - 128) * 128);
    for (int i = 0; i < RF_TAPS; i++) {
        taps.near_by[i] = nearness(off - i * 256);
        taps.share[i] = (int16_t)(mean_weight(off - i * 256) / (6 << (24 - 15)));
        left -= taps.share[i];
        greatest = taps.share[i] > taps.share[greatest] ? i : greatest;
    }
    taps.share[greatest] = (int16_t)(taps.share[greatest] + left);
    return taps;
}

static void widen_row(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int y = up->first_wide + item;

    (void)worker;
    up->kernels->widen4(up->wide.at + item * up->wide.stride, up->coarse.at + y * up->coarse.stride,
                        up->across, up->photo->width);
}

/* Three rows, of which the middle one is settled. */
struct three {
    const uint16_t *row[3];
    const uint8_t *sure[3];
    uint16_t *out;
};

/* n pixels of which some are not sure, from those around; at the border, of one block.
 */
static void settle_block(const struct rf_upsampler *up, const struct three *three, int x, int n)
{
    const int right = up->photo->width - 1;
    uint16_t near_by[3][BLOCK + 2];
    uint8_t near_sure[3][BLOCK + 2];
    const uint16_t *row[3];
    const uint8_t *sure[3];
    const bool inside = x > 0 && x + n <= right;

    for (int j = 0; j < 3; j++) {
        row[j] = three->row[j] + x;
        sure[j] = three->sure[j] + x;
        for (int i = -1; i <= n && !inside; i++) {
            near_by[j][i + 1] = row[j][rf_clamp(x + i, 0, right) - x];
            near_sure[j][i + 1] = sure[j][rf_clamp(x + i, 0, right) - x];
        }
        row[j] = inside ? row[j] : near_by[j] + 1;
        sure[j] = inside ? sure[j] : near_sure[j] + 1;
    }
    up->kernels->median3(three->out + x, row, sure, n);
}

static void settle_row(const struct rf_upsampler *up, int y)
{
    const int kept = y - up->first_row;
    const uint16_t *unsure = up->unsure.at + kept * up->unsure.stride;
    const int width = up->photo->width, blocks = unsure[0];
    struct three three = {.out = up->settled.at + kept * up->settled.stride};

    for (int j = 0; j < 3; j++) {
        const ptrdiff_t v = rf_clamp(y - 1 + j, 0, up->photo->height - 1);

        three.row[j] = up->out.at + v * up->out.stride;
        three.sure[j] = up->sure.at + (v - up->first_row) * up->sure.stride;
    }
    for (int i = 1; i <= blocks; i++) {
        const int x = unsure[i] * BLOCK;
        int n = width - x < BLOCK ? width - x : BLOCK;

        for (; x > 0 && i < blocks && unsure[i + 1] == unsure[i] + 1 && x + n + BLOCK < width;
             n += BLOCK)
            i++;
        settle_block(up, &three, x, n);
    }
}

static void take_over_row(const struct rf_upsampler *up, int y)
{
    const int kept = y - up->first_row;
    const uint16_t *unsure = up->unsure.at + kept * up->unsure.stride;
    const int width = up->photo->width;

    for (int i = 1; i <= unsure[0]; i++) {
        const int x = unsure[i] * BLOCK, n = width - x < BLOCK ? width - x : BLOCK;
        uint16_t *out = up->out.at + y * up->out.stride + x;
        const uint16_t *settled = up->settled.at + kept * up->settled.stride + x;

        if (n == BLOCK)
            memcpy(out, settled, BLOCK * sizeof *out);
        else
            memcpy(out, settled, (size_t)n * sizeof *out);
    }
}

/* The first row whose taps begin at `first` or later. */
static int row_of(const struct rf_upsampler *up, int first)
{
    int low = 0, high = up->photo->height;

    while (low < high) {
        const int middle = low + (high - low) / 2;

        if (up->down[middle].first < first)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The first row of pixels of a band. */
static int row_of_band(const struct rf_upsampler *up, int band)
{
    return row_of(up, band * SPAN - PAD);
}

/* The rows of pixels of a band, SPAN rows of samples. Pixels that are not sure are settled in a
 * plane of their own, as their neighbours need the values from before, and then copied to the
 * result: here as far as that needs no other band, while they are in the cache. */
static void fill_band(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int first = (up->first_band + item) * SPAN - PAD, y0 = row_of(up, first);
    int y1 = y0;

    for (int i = 0; i < SPAN; i++) {
        const int begin = y1;

        y1 = row_of(up, first + i + 1);
        if (begin < y1)
            rf_upsample_rows(up, first + i, begin, y1, worker);
    }
    for (int y = y0 + 1; y < y1 - 1 && !rf_run_cancelled(up->run); y++)
        settle_row(up, y);
    for (int y = y0 + 2; y < y1 - 2 && !rf_run_cancelled(up->run); y++)
        take_over_row(up, y);
}

static void settle_border(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int band = up->first_band + item;
    const int y0 = row_of_band(up, band), y1 = row_of_band(up, band + 1);

    (void)worker;
    if (y0 < y1)
        settle_row(up, y0);
    if (y0 < y1 - 1)
        settle_row(up, y1 - 1);
}

static void take_over_border(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int band = up->first_band + item;
    const int y0 = row_of_band(up, band), y1 = row_of_band(up, band + 1);

    (void)worker;
    for (int y = y0; y < y1; y++)
        if (y < y0 + 2 || y >= y1 - 2)
            take_over_row(up, y);
}

static void run_bands(struct rf_upsampler *up, struct rf_pool *pool, rf_work_fn *work, int begin,
                      int end)
{
    up->first_band = begin;
    if (begin < end)
        rf_pool_run(pool, work, up, end - begin);
}

/* Makes room for the rows of a strip behind those of the two bands before it. */
static void move_rows(struct rf_upsampler *up, int first_row, int end)
{
    const ptrdiff_t at = first_row - up->first_row;
    const size_t rows = (size_t)(end - first_row);

    if (at > 0) {
        memmove(up->settled.at, up->settled.at + at * up->settled.stride,
                rows * (size_t)up->settled.stride * sizeof *up->settled.at);
        memmove(up->sure.at, up->sure.at + at * up->sure.stride, rows * (size_t)up->sure.stride);
        memmove(up->unsure.at, up->unsure.at + at * up->unsure.stride,
                rows * (size_t)up->unsure.stride * sizeof *up->unsure.at);
    }
    up->first_row = first_row;
}

/* A band is settled when the one behind it is filled, as its last row needs the first of that, and
 * taken over when the one behind it is settled. */
static void fill_strip(struct rf_upsampler *up, struct rf_pool *pool, int begin, int end)
{
    const int bands = (up->rows + SPAN) / SPAN; /* rows + 1 in all */
    const int settled = end < bands ? end - 1 : bands, taken = end < bands ? end - 2 : bands;
    const int last = rf_clamp(end * SPAN - PAD + RF_TAPS - 1, 0, up->rows - 1);

    up->first_wide = rf_clamp(begin * SPAN - PAD, 0, up->rows - 1);
    rf_pool_run(pool, widen_row, up, last - up->first_wide + 1);
    run_bands(up, pool, fill_band, begin, end);
    run_bands(up, pool, settle_border, begin ? begin - 1 : 0, settled);
    run_bands(up, pool, take_over_border, begin ? begin - 2 : 0, taken);
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool)
{
    const int width = up->photo->width, height = up->photo->height;
    const int bands = (up->rows + SPAN) / SPAN;
    const int strip = up->in_strips ? STRIP : bands;

    up->run = pool->run;
    for (int x = 0; x < width; x++)
        up->across[x] = taps_at(x, width, up->columns);
    rf_find_spans(up);
    for (int y = 0; y < height; y++)
        up->down[y] = taps_at(y, height, up->rows);
    rf_upsample_load(up, pool);
    for (int i = 0; i < bands && !rf_run_cancelled(up->run); i += strip) {
        move_rows(up, i ? row_of_band(up, i - 2) : 0, row_of_band(up, i));
        fill_strip(up, pool, i, i + strip < bands ? i + strip : bands);
    }
}
