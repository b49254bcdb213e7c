#include "depth/upsample.h"

#include <stdlib.h>
#include <string.h>

enum {
    PAD = 2,              /* samples beyond the map's border, repeated */
    STEP = 65535 / 24,    /* largest one within a surface */
    SURFACE = 65535 / 12, /* samples closer than this are of one surface */
    BAND = 16,            /* rows of a work item */
    RUN = 8,              /* pixels that are collected together */
};

/* Cubic B-spline, for means: it smooths noise, and keeps slopes. t in Q8, result in Q24 / 6. */
static int mean_weight(int t)
{
    const int64_t a = abs(t), left = 512 - a;

    if (a >= 512)
        return 0;
    return (int)(a >= 256 ? left * left * left
                          : 4 * (1 << 24) - 6 * 256 * a * a + 3 * a * a * a);
}

/* (1 - (t / 2.6)^2)^2 sqrt(1/8) in Q16 for the choice: wider, or it would be all nearness.
 * In both directions four by four of them add up to less than 1. */
static uint16_t nearness(int64_t t)
{
    const int64_t fall = 65536 - t * t * 65536 / (666 * 666);

    return (uint16_t)((fall * fall >> 16) * 23170 >> 16);
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
    int weight[RF_TAPS], sum = 0, left = 65536, greatest = 0;

    for (int i = 0; i < RF_TAPS; i++) {
        weight[i] = mean_weight((int)(at - ((int64_t)taps.first + i) * 256));
        sum += weight[i];
    }
    for (int i = 0; i < RF_TAPS; i++) {
        taps.share[i] = (uint16_t)(((int64_t)weight[i] << 16) / sum);
        left -= taps.share[i];
        greatest = taps.share[i] > taps.share[greatest] ? i : greatest;
    }
    taps.share[greatest] = (uint16_t)(taps.share[greatest] + left);
    return taps;
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Which of `size` columns or rows is the i-th of `samples`. */
static int place(int i, int samples, int size)
{
    return (int)((2 * (int64_t)clamp(i, samples - 1) + 1) * size / (2 * (int64_t)samples));
}

static void load_row(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const struct refocus_disparity *map = up->map;
    const int y = item - PAD;
    const uint8_t *in =
        (const uint8_t *)map->samples + place(y, up->rows, map->height) * map->stride;
    uint16_t *out = up->coarse + y * up->coarse_stride;

    (void)worker;
    for (int x = -PAD; x < up->columns + PAD; x++) {
        const int i = place(x, up->columns, map->width);

        out[x] = (uint16_t)(map->bits == 16 ? ((const uint16_t *)in)[i] : in[i] * 257);
    }
}

static void widen_row(void *context, int y, int worker)
{
    const struct rf_upsampler *up = context;
    const uint16_t *in = up->coarse + y * up->coarse_stride;
    uint16_t *out = up->wide + y * up->wide_stride;
    const int width = up->photo->width;

    (void)worker;
    for (int x = 0; x < width; x++) {
        const struct rf_taps *taps = &up->across[x];
        const uint16_t *d = in + taps->first;

        out[x] = (uint16_t)(((uint32_t)d[0] * taps->share[0] + (uint32_t)d[1] * taps->share[1] +
                             (uint32_t)d[2] * taps->share[2] + (uint32_t)d[3] * taps->share[3] +
                             (1 << 15)) >> 16);
    }
}

/* What the photo and the sensor say about 4 x 4 samples, and where they are. */
static void look(struct rf_cell *cell, const struct rf_upsampler *up, int x, int y)
{
    const struct refocus_image *photo = up->photo;
    const uint8_t *row[RF_TAPS];

    for (int i = 0; i < RF_TAPS; i++)
        row[i] = photo->plane[0] + place(y + i, up->rows, photo->height) * photo->stride[0];
    for (int i = 0; i < RF_SAMPLES; i++) {
        const int sx = x + i % RF_TAPS, sy = y + i / RF_TAPS;
        const uint8_t *p = row[i / RF_TAPS] + up->column[sx];

        cell->disparity[i] = up->coarse[sy * up->coarse_stride + sx];
        for (int c = 0; c < 3; c++)
            cell->colour[c][i] = p[c];
        cell->trust[i] = 65535;
        if (up->confidence) {
            const uint8_t *sure = up->confidence +
                                  place(sy, up->rows, up->map->height) * up->confidence_stride;
            const int trust = sure[place(sx, up->columns, up->map->width)];

            cell->trust[i] = (uint16_t)(trust < 1 ? 16 : trust * 257);
        }
    }
}

/* Every longest run of sorted samples no longer than SURFACE. */
static void find_windows(struct rf_cell *cell)
{
    uint16_t sorted[RF_SAMPLES];
    int last_end = 0;

    for (int i = 0; i < RF_SAMPLES; i++) {
        const uint16_t d = cell->disparity[i];
        int at = i;

        for (; at > 0 && sorted[at - 1] > d; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = d;
    }
    cell->windows = 0;
    for (int begin = 0, end = 0; last_end < RF_SAMPLES; begin++) {
        while (end < RF_SAMPLES && sorted[end] - sorted[begin] <= SURFACE)
            end++;
        if (end > last_end) {
            cell->low[cell->windows] = sorted[begin];
            cell->high[cell->windows++] = sorted[end - 1];
            last_end = end;
        }
    }
}

/* Whether the 4 x 4 samples from (x, y) are of one surface that is known everywhere. */
static bool is_smooth(const struct rf_upsampler *up, const uint16_t *across,
                      const uint16_t *down, int x, int y)
{
    for (int i = 0; i < RF_TAPS; i++)
        if (down[x + i] > STEP || (i < RF_TAPS - 1 && across[x + i] > STEP))
            return false;
    if (!up->confidence)
        return true;
    for (int i = 0; i < RF_SAMPLES; i++) {
        const int sy = place(y + i / RF_TAPS, up->rows, up->map->height);
        const int sx = place(x + i % RF_TAPS, up->columns, up->map->width);

        if (up->confidence[sy * up->confidence_stride + sx] != 255)
            return false;
    }
    return true;
}

/* Rows of pixels between the same samples that are worked out together. */
struct pending {
    struct rf_batch batch;
    uint16_t result[RF_BATCH + RF_BATCH_SPARE];
    uint16_t *to[RF_BATCH];
    int length[RF_BATCH], runs, pixels;
};

static void flush(const struct rf_upsampler *up, const struct rf_cell *cell,
                  struct pending *pending)
{
    const uint16_t *from = pending->result;

    if (pending->pixels)
        up->kernels->cluster(pending->result, cell, &pending->batch, pending->pixels);
    for (int i = 0; i < pending->runs; i++) {
        for (int x = 0; x < pending->length[i]; x++)
            pending->to[i][x] = from[x];
        from += pending->length[i];
    }
    pending->runs = pending->pixels = 0;
}

/* n pixels from (x, y) on, at most 8: copies of 8 cost less than copies of n. */
static void collect(const struct rf_upsampler *up, struct pending *pending, int x, int y, int n,
                    const uint16_t down[RF_TAPS], int bytes)
{
    struct rf_batch *batch = &pending->batch;
    const int at = pending->pixels;
    const uint8_t *p =
        up->photo->plane[0] + y * up->photo->stride[0] + (ptrdiff_t)x * bytes;

    for (int i = 0; i < RF_TAPS; i++) {
        memcpy(batch->across[i] + at, up->near_by[i] + x, RUN * sizeof(uint16_t));
        for (int k = 0; k < RUN; k++)
            batch->down[i][at + k] = down[i];
    }
    for (int k = 0; k < n; k++, p += bytes) {
        batch->colour[0][at + k] = p[0];
        batch->colour[1][at + k] = p[1];
        batch->colour[2][at + k] = p[2];
    }
    pending->to[pending->runs] = up->raw + y * up->raw_stride + x;
    pending->length[pending->runs++] = n;
    pending->pixels += n;
}

/* Pixels x0 to x1 - 1 of rows y0 to y1 - 1, which lie between the same samples. */
static void fill_cell(const struct rf_upsampler *up, int x0, int x1, int y0, int y1)
{
    const int bytes = refocus_format_bytes(up->photo->format);
    struct rf_cell cell;
    struct pending pending;

    look(&cell, up, up->across[x0].first, up->down[y0].first);
    find_windows(&cell);
    pending.runs = pending.pixels = 0;
    for (int y = y0; y < y1; y++) {
        const int64_t at = position(y, up->photo->height, up->rows);
        uint16_t down[RF_TAPS];

        if (rf_run_cancelled(up->run))
            return;
        for (int i = 0; i < RF_TAPS; i++)
            down[i] = nearness(at - ((int64_t)up->down[y].first + i) * 256);
        for (int x = x0; x < x1; x += RUN) {
            const int n = x1 - x < RUN ? x1 - x : RUN;

            if (pending.pixels + n > RF_BATCH)
                flush(up, &cell, &pending);
            collect(up, &pending, x, y, n, down, bytes);
        }
    }
    flush(up, &cell, &pending);
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

/* All rows of pixels that lie between the same rows of samples. */
static void fill_rows(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int first = item - PAD, width = up->photo->width;
    const int y0 = row_of(up, first), y1 = row_of(up, first + 1);
    uint16_t *across = up->scratch(up->context, worker) + PAD;
    uint16_t *down = across + up->columns + 8;
    const uint16_t *coarse[RF_TAPS], *wide[RF_TAPS];

    if (y0 == y1)
        return;
    for (int i = 0; i < RF_TAPS; i++) {
        coarse[i] = up->coarse + (first + i) * up->coarse_stride - PAD;
        wide[i] = up->wide + clamp(first + i, up->rows - 1) * up->wide_stride;
    }
    up->kernels->steps4(across - PAD, down - PAD, coarse, up->columns + 2 * PAD - 1);
    down[up->columns + PAD - 1] = down[up->columns + PAD - 2];
    for (int y = y0; y < y1 && !rf_run_cancelled(up->run); y++)
        up->kernels->blend4(up->raw + y * up->raw_stride, wide,
                            up->down[y].share, width);
    for (int x0 = 0, x1; x0 < width; x0 = x1) {
        for (x1 = x0 + 1; x1 < width && up->across[x1].first == up->across[x0].first;)
            x1++;
        if (!is_smooth(up, across, down, up->across[x0].first, first))
            fill_cell(up, x0, x1, y0, y1);
    }
    for (int y = y0; y < y1; y++) {
        uint16_t *row = up->raw + y * up->raw_stride;

        row[-1] = row[0];
        row[width] = row[width - 1];
    }
}

static void median_rows(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const int last = up->photo->height - 1;

    (void)worker;
    for (int y = item * BAND; y <= last && y < (item + 1) * BAND; y++)
        up->kernels->median3(up->out + y * up->out_stride,
                             up->raw + clamp(y - 1, last) * up->raw_stride,
                             up->raw + y * up->raw_stride,
                             up->raw + clamp(y + 1, last) * up->raw_stride, up->photo->width);
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool)
{
    const int width = up->photo->width, height = up->photo->height;

    up->run = pool->run;
    for (int x = 0; x < width; x++) {
        const int64_t at = position(x, width, up->columns);

        up->across[x] = taps_at(x, width, up->columns);
        for (int i = 0; i < RF_TAPS; i++)
            up->near_by[i][x] = nearness(at - ((int64_t)up->across[x].first + i) * 256);
    }
    for (int i = 0; i < RF_TAPS; i++)
        memset(up->near_by[i] + width, 0, RF_BATCH_SPARE * sizeof(uint16_t));
    for (int y = 0; y < height; y++)
        up->down[y] = taps_at(y, height, up->rows);
    for (int x = -PAD; x < up->columns + PAD; x++)
        up->column[x] = place(x, up->columns, width) * refocus_format_bytes(up->photo->format);
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    rf_pool_run(pool, widen_row, up, up->rows);
    rf_pool_run(pool, fill_rows, up, up->rows + 1);
    rf_pool_run(pool, median_rows, up, (height + BAND - 1) / BAND);
}
