/* upsample.c: brings a disparity map to the size of the photo: means, and the order of steps. */
#include "depth/upsample.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "depth/dequantise.h"

enum {
    PAD = RF_UPSAMPLE_PAD,
    SPAN = 4, /* rows of samples of a work item */
    BLOCK = RF_UPSAMPLE_BLOCK,
    QUARTER = 2, /* shift of colours: sums of three differences then fit */
};

void rf_upsampler_lay_out(struct rf_upsampler *up, struct rf_arena *arena)
{
    const uint64_t width = (uint64_t)up->photo->width, height = (uint64_t)up->photo->height;
    const uint64_t columns = (uint64_t)up->columns, rows = (uint64_t)up->rows;

    up->coarse.stride = up->columns + 4;
    up->coarse.at = rf_arena_take(arena, (columns + 4) * (rows + 4), 2);
    up->wide.stride = up->photo->width;
    up->wide.at = rf_arena_take(arena, width * rows, 2);
    up->settled.stride = up->photo->width;
    up->settled.at = rf_arena_take(arena, width * height, 2);
    up->across = rf_arena_take(arena, width, sizeof *up->across);
    up->down = rf_arena_take(arena, height, sizeof *up->down);
    up->span = rf_arena_take(arena, columns + 2, sizeof *up->span);
    up->colour.stride = up->trust.stride = up->coarse.stride;
    for (int c = 0; c < 3; c++)
        up->colour.channel[c] = rf_arena_take(arena, (columns + 4) * (rows + 4), 1);
    if (up->confidence)
        up->trust.at = rf_arena_take(arena, (columns + 4) * (rows + 4), 1);
    up->sure.stride = up->photo->width;
    up->sure.at = rf_arena_take(arena, width * height, 1);
    up->unsure.stride = rf_upsample_blocks(up->photo->width) + 1;
    up->unsure.at = rf_arena_take(arena, (uint64_t)up->unsure.stride * height, 2);
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

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* The column or row, of `size`, that the i-th of `samples` lies on. */
static int place(int i, int samples, int size)
{
    return (int)((2 * (int64_t)clamp(i, samples - 1) + 1) * size / (2 * (int64_t)samples));
}

/* place() of 0, 1, 2 ... without divisions: `at` and `rest` / per. */
struct walk {
    int64_t at, step, rest, over, per;
};

static struct walk walk_from_0(int samples, int size)
{
    return (struct walk){.at = size / (2 * (int64_t)samples),
                         .step = size / samples,
                         .rest = size % (2 * (int64_t)samples),
                         .over = 2 * (int64_t)(size % samples),
                         .per = 2 * (int64_t)samples};
}

static inline void walk_on(struct walk *walk)
{
    walk->rest += walk->over;
    walk->at += walk->step + (walk->rest >= walk->per);
    walk->rest -= walk->rest >= walk->per ? walk->per : 0;
}

static void load_colours(const struct rf_upsampler *up, int y)
{
    const struct refocus_image *photo = up->photo;
    const int bytes = refocus_format_bytes(photo->format), n = up->columns;
    const uint8_t *row = photo->plane[0] + place(y, up->rows, photo->height) * photo->stride[0];
    const struct rf_span *restrict span = up->span;
    uint8_t *const out[3] = {up->colour.channel[0] + y * up->colour.stride,
                             up->colour.channel[1] + y * up->colour.stride,
                             up->colour.channel[2] + y * up->colour.stride};
    uint8_t *restrict first = out[0], *restrict second = out[1], *restrict third = out[2];

    for (int x = 0; x < n; x++) {
        const uint8_t *restrict pixel = row + (ptrdiff_t)span[x].shown * bytes;

        first[x] = (uint8_t)(pixel[0] >> QUARTER);
        second[x] = (uint8_t)(pixel[1] >> QUARTER);
        third[x] = (uint8_t)(pixel[2] >> QUARTER);
    }
    for (int c = 0; c < 3; c++) {
        memset(out[c] - PAD, out[c][0], PAD);
        memset(out[c] + n, out[c][n - 1], PAD);
    }
}

static void load_trust(const struct rf_upsampler *up, int y)
{
    const uint8_t *row =
        up->confidence + place(y, up->rows, up->map->height) * up->confidence_stride;
    struct walk walk = walk_from_0(up->columns, up->map->width);
    uint8_t *out = up->trust.at + y * up->trust.stride;

    for (int x = 0; x < up->columns; x++, walk_on(&walk))
        out[x] = row[walk.at];
    memset(out - PAD, out[0], PAD);
    memset(out + up->columns, out[up->columns - 1], PAD);
}

/* Loads as many samples as the map has columns, or fewer. */
static void load_samples(const struct rf_upsampler *up, uint16_t *out, const void *in)
{
    struct walk walk = walk_from_0(up->columns, up->map->width);

    if (up->map->bits == 16 && up->columns == up->map->width)
        memcpy(out, in, (size_t)up->columns * sizeof *out);
    else if (up->map->bits == 16)
        for (int x = 0; x < up->columns; x++, walk_on(&walk))
            out[x] = ((const uint16_t *)in)[walk.at];
    else
        for (int x = 0; x < up->columns; x++, walk_on(&walk))
            out[x] = (uint16_t)(((const uint8_t *)in)[walk.at] * 257);
}

static void repeat_ends(uint16_t *row, int n)
{
    for (int i = 1; i <= PAD; i++) {
        row[-i] = row[0];
        row[n - 1 + i] = row[n - 1];
    }
}

/* Loads a row of samples, the photo's colours there, and the confidence in them. */
static void load_row(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const struct refocus_disparity *map = up->map;
    const int y = item - PAD, n = up->columns;
    const uint8_t *in =
        (const uint8_t *)map->samples + place(y, up->rows, map->height) * map->stride;
    uint16_t *out = up->coarse.at + y * up->coarse.stride;

    (void)worker;
    load_samples(up, out, in);
    repeat_ends(out, n);
    load_colours(up, y);
    if (up->confidence)
        load_trust(up, y);
}

/* Makes slopes of the steps of a map with few codes. The planes of later steps are still free. */
static void dequantise_samples(const struct rf_upsampler *up, struct rf_pool *pool)
{
    const struct rf_dequantiser d = {
        .kernels = up->kernels,
        .code = up->coarse,
        .spare = {up->wide, up->settled},
        .width = up->columns,
        .height = up->rows,
        .step = rf_code_step(up->map),
    };

    if (!d.step)
        return;
    rf_dequantise(&d, pool);
    for (int y = 0; y < up->rows; y++)
        repeat_ends(up->coarse.at + y * up->coarse.stride, up->columns);
    for (int i = 1; i <= PAD; i++) {
        const size_t bytes = (size_t)(up->columns + 2 * PAD) * sizeof *up->coarse.at;
        uint16_t *const last = up->coarse.at + (up->rows - 1) * up->coarse.stride;

        memcpy(up->coarse.at - i * up->coarse.stride - PAD, up->coarse.at - PAD, bytes);
        memcpy(last + i * up->coarse.stride - PAD, last - PAD, bytes);
    }
}

static void widen_row(void *context, int y, int worker)
{
    const struct rf_upsampler *up = context;

    (void)worker;
    up->kernels->widen4(up->wide.at + y * up->wide.stride, up->coarse.at + y * up->coarse.stride,
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
            near_by[j][i + 1] = row[j][clamp(x + i, right) - x];
            near_sure[j][i + 1] = sure[j][clamp(x + i, right) - x];
        }
        row[j] = inside ? row[j] : near_by[j] + 1;
        sure[j] = inside ? sure[j] : near_sure[j] + 1;
    }
    up->kernels->median3(three->out + x, row, sure, n);
}

static void settle_row(const struct rf_upsampler *up, int y)
{
    const uint16_t *unsure = up->unsure.at + y * up->unsure.stride;
    const int width = up->photo->width, blocks = unsure[0];
    struct three three = {.out = up->settled.at + y * up->settled.stride};

    for (int j = 0; j < 3; j++) {
        const ptrdiff_t v = clamp(y - 1 + j, up->photo->height - 1);

        three.row[j] = up->out.at + v * up->out.stride;
        three.sure[j] = up->sure.at + v * up->sure.stride;
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
    const uint16_t *unsure = up->unsure.at + y * up->unsure.stride;
    const int width = up->photo->width;

    for (int i = 1; i <= unsure[0]; i++) {
        const int x = unsure[i] * BLOCK, n = width - x < BLOCK ? width - x : BLOCK;
        uint16_t *out = up->out.at + y * up->out.stride + x;
        const uint16_t *settled = up->settled.at + y * up->settled.stride + x;

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

/* The rows of pixels of a band, SPAN rows of samples. Pixels that are not sure are settled in a
 * plane of their own, as their neighbours need the values from before, and then copied to the
 * result: here as far as that needs no other band, while they are in the cache. */
static void fill_band(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int first = item * SPAN - PAD, y0 = row_of(up, first);
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
    const int y0 = row_of(up, item * SPAN - PAD), y1 = row_of(up, (item + 1) * SPAN - PAD);

    (void)worker;
    if (y0 < y1)
        settle_row(up, y0);
    if (y0 < y1 - 1)
        settle_row(up, y1 - 1);
}

static void take_over_border(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int y0 = row_of(up, item * SPAN - PAD), y1 = row_of(up, (item + 1) * SPAN - PAD);

    (void)worker;
    for (int y = y0; y < y1; y++)
        if (y < y0 + 2 || y >= y1 - 2)
            take_over_row(up, y);
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool)
{
    const int width = up->photo->width, height = up->photo->height;
    const int bands = (up->rows + SPAN) / SPAN; /* rows + 1 in all */

    struct walk walk = walk_from_0(up->columns, width);

    up->run = pool->run;
    for (int i = 0; i < up->columns; i++, walk_on(&walk))
        up->span[i].shown = (int32_t)walk.at;
    for (int x = 0; x < width; x++)
        up->across[x] = taps_at(x, width, up->columns);
    rf_find_spans(up);
    for (int y = 0; y < height; y++)
        up->down[y] = taps_at(y, height, up->rows);
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    dequantise_samples(up, pool);
    rf_pool_run(pool, widen_row, up, up->rows);
    rf_pool_run(pool, fill_band, up, bands);
    rf_pool_run(pool, settle_border, up, bands);
    rf_pool_run(pool, take_over_border, up, bands);
}
