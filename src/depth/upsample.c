#include "depth/upsample.h"

#include <stdlib.h>
#include <string.h>

enum {
    PAD = 2,              /* samples beyond the map's border, repeated */
    STEP = 65535 / 24,    /* largest one within a surface */
    BAND = 16,            /* rows of a work item */
    RUN = 8,              /* pixels that are collected together */
    CHUNK = 256,          /* pixels that are looked at together for a median */
    HALF = 1,             /* shift of colours: sums of three differences then fit */
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

/* 0.465 (1 - (t / 2)^2)^2 in Q16 for what is expected before the photo is looked at: four of
 * them add up to less than 1. t in Q8. */
static uint16_t nearness(int64_t t)
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
    int weight[RF_TAPS], sum = 0, left = 65536, greatest = 0;

    for (int i = 0; i < RF_TAPS; i++) {
        weight[i] = mean_weight((int)(at - ((int64_t)taps.first + i) * 256));
        sum += weight[i];
        taps.near_by[i] = nearness(at - ((int64_t)taps.first + i) * 256);
    }
    taps.middle = (int16_t)((at - ((int64_t)taps.first + 1) * 256 - 128) * 128);
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

/* A row of samples, what the photo shows there, and how sure they are. */
static void load_row(void *context, int item, int worker)
{
    const struct rf_upsampler *up = context;
    const struct refocus_disparity *map = up->map;
    const struct refocus_image *photo = up->photo;
    const int y = item - PAD, bytes = refocus_format_bytes(photo->format);
    const uint8_t *in =
        (const uint8_t *)map->samples + place(y, up->rows, map->height) * map->stride;
    const uint8_t *row = photo->plane[0] + place(y, up->rows, photo->height) * photo->stride[0];
    uint16_t *out = up->coarse + y * up->coarse_stride;

    (void)worker;
    for (int x = -PAD; x < up->columns + PAD; x++) {
        const int i = place(x, up->columns, map->width);
        const uint8_t *p = row + (ptrdiff_t)place(x, up->columns, photo->width) * bytes;

        out[x] = (uint16_t)(map->bits == 16 ? ((const uint16_t *)in)[i] : in[i] * 257);
        for (int c = 0; c < 3; c++)
            up->colour[c][y * up->colour_stride + x] = (uint8_t)(p[c] >> HALF);
    }
    if (up->confidence) {
        const uint8_t *sure =
            up->confidence + place(y, up->rows, map->height) * up->confidence_stride;

        for (int x = -PAD; x < up->columns + PAD; x++)
            up->trust[y * up->trust_stride + x] = sure[place(x, up->columns, map->width)];
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

/* Eight elements of one or two bytes from the x-th of a row on, which is repeated at its ends. */
static inline void copy8(void *to, const void *row, int x, int columns, size_t size)
{
    if (x >= -PAD && x + RF_AROUND <= columns + PAD) {
        memcpy(to, (const char *)row + x * (ptrdiff_t)size, RF_AROUND * size);
        return;
    }
    for (int i = 0; i < RF_AROUND; i++)
        memcpy((char *)to + (size_t)i * size,
               (const char *)row + (size_t)clamp(x + i, columns - 1) * size, size);
}

/* What the photo and the sensor say about the samples around those from (x, y) on. */
static void look(struct rf_cell *cell, const struct rf_upsampler *up, int x, int y)
{
    uint16_t disparity[RF_SAMPLES];
    uint8_t trust[RF_SAMPLES];

    for (int j = 0; j < RF_AROUND; j++) {
        const ptrdiff_t row = clamp(y - 2 + j, up->rows - 1);

        copy8(disparity + j * RF_AROUND, up->coarse + row * up->coarse_stride, x - 2,
              up->columns, sizeof *disparity);
        for (int c = 0; c < 3; c++)
            copy8(cell->colour[c] + j * RF_AROUND, up->colour[c] + row * up->colour_stride,
                  x - 2, up->columns, 1);
        if (up->confidence)
            copy8(trust + j * RF_AROUND, up->trust + row * up->trust_stride, x - 2,
                  up->columns, 1);
    }
    up->kernels->find_surfaces(cell, disparity, up->confidence ? trust : NULL);
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
    for (int i = 0; i < RF_TAPS; i++)
        for (int j = 0; j < RF_TAPS; j++)
            if (up->trust[(y + i) * up->trust_stride + x + j] != 255)
                return false;
    return true;
}

/* Rows of pixels between the same samples that are worked out together. */
struct pending {
    struct rf_cell cell;
    struct rf_batch batch;
    uint16_t result[RF_BATCH];
    uint8_t sure[RF_BATCH];
    int x[RF_BATCH], y[RF_BATCH], length[RF_BATCH], runs, pixels;
};

static void flush(const struct rf_upsampler *up, struct pending *pending)
{
    int from = 0;

    if (pending->pixels)
        up->kernels->surface(pending->result, pending->sure, &pending->cell, &pending->batch,
                             pending->pixels);
    for (int i = 0; i < pending->runs; i++) {
        uint16_t *to = up->raw + pending->y[i] * up->raw_stride + pending->x[i];
        uint8_t *sure = up->sure + pending->y[i] * up->sure_stride + pending->x[i];

        for (int x = 0; x < pending->length[i]; x++) {
            to[x] = pending->result[from + x];
            sure[x] = pending->sure[from + x];
        }
        from += pending->length[i];
    }
    pending->runs = pending->pixels = 0;
}

/* n pixels from (x, y) on, at most 8: copies of 8 cost less than copies of n. */
static void collect(const struct rf_upsampler *up, struct pending *pending, int x, int y, int n,
                    const struct rf_taps *down, int bytes)
{
    struct rf_batch *batch = &pending->batch;
    const int at = pending->pixels;
    const uint8_t *p =
        up->photo->plane[0] + y * up->photo->stride[0] + (ptrdiff_t)x * bytes;

    for (int i = 0; i < RF_TAPS; i++) {
        memcpy(batch->across[i] + at, up->near_by[i] + x, RUN * sizeof(uint16_t));
        for (int k = 0; k < RUN; k++)
            batch->down[i][at + k] = down->near_by[i];
    }
    memcpy(batch->x + at, up->middle + x, RUN * sizeof(int16_t));
    for (int k = 0; k < RUN; k++)
        batch->y[at + k] = down->middle;
    for (int k = 0; k < n; k++, p += bytes) {
        batch->colour[0][at + k] = (uint8_t)(p[0] >> HALF);
        batch->colour[1][at + k] = (uint8_t)(p[1] >> HALF);
        batch->colour[2][at + k] = (uint8_t)(p[2] >> HALF);
    }
    pending->x[pending->runs] = x;
    pending->y[pending->runs] = y;
    pending->length[pending->runs++] = n;
    pending->pixels += n;
}

/* Pixels x0 to x1 - 1 of rows y0 to y1 - 1, which lie between the same samples. */
static void fill_cell(const struct rf_upsampler *up, struct pending *pending, int x0, int x1,
                      int y0, int y1)
{
    const int bytes = refocus_format_bytes(up->photo->format);

    look(&pending->cell, up, up->across[x0].first, up->down[y0].first);
    for (int y = y0; y < y1; y++) {
        if (rf_run_cancelled(up->run))
            return;
        for (int x = x0; x < x1; x += RUN) {
            const int n = x1 - x < RUN ? x1 - x : RUN;

            if (pending->pixels + n > RF_BATCH)
                flush(up, pending);
            collect(up, pending, x, y, n, &up->down[y], bytes);
        }
    }
    flush(up, pending);
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
    struct pending pending;

    if (y0 == y1)
        return;
    memset(&pending, 0, sizeof pending);
    for (int i = 0; i < RF_TAPS; i++) {
        coarse[i] = up->coarse + (first + i) * up->coarse_stride - PAD;
        wide[i] = up->wide + clamp(first + i, up->rows - 1) * up->wide_stride;
    }
    up->kernels->steps4(across - PAD, down - PAD, coarse, up->columns + 2 * PAD - 1);
    down[up->columns + PAD - 1] = down[up->columns + PAD - 2];
    for (int y = y0; y < y1 && !rf_run_cancelled(up->run); y++) {
        up->kernels->blend4(up->raw + y * up->raw_stride, wide, up->down[y].share, width);
        memset(up->sure + y * up->sure_stride, 255, (size_t)width);
    }
    for (int x0 = 0, x1; x0 < width; x0 = x1) {
        for (x1 = x0 + 1; x1 < width && up->across[x1].first == up->across[x0].first;)
            x1++;
        if (!is_smooth(up, across, down, up->across[x0].first, first))
            fill_cell(up, &pending, x0, x1, y0, y1);
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
    const int width = up->photo->width, last = up->photo->height - 1;

    (void)worker;
    for (int y = item * BAND; y <= last && y < (item + 1) * BAND; y++) {
        const uint16_t *row = up->raw + y * up->raw_stride;
        const uint16_t *before = up->raw + clamp(y - 1, last) * up->raw_stride;
        const uint16_t *after = up->raw + clamp(y + 1, last) * up->raw_stride;
        const uint8_t *sure = up->sure + y * up->sure_stride;
        uint16_t *out = up->out + y * up->out_stride;

        for (int x = 0; x < width; x += CHUNK) {
            const int n = width - x < CHUNK ? width - x : CHUNK;

            if (memchr(sure + x, 0, (size_t)n))
                up->kernels->median3(out + x, before + x, row + x, after + x, sure + x, n);
            else
                memcpy(out + x, row + x, (size_t)n * sizeof *out);
        }
    }
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool)
{
    const int width = up->photo->width, height = up->photo->height;

    up->run = pool->run;
    for (int x = 0; x < width; x++) {
        up->across[x] = taps_at(x, width, up->columns);
        for (int i = 0; i < RF_TAPS; i++)
            up->near_by[i][x] = up->across[x].near_by[i];
        up->middle[x] = up->across[x].middle;
    }
    memset(up->middle + width, 0, RF_BATCH_SPARE * sizeof(int16_t));
    for (int i = 0; i < RF_TAPS; i++)
        memset(up->near_by[i] + width, 0, RF_BATCH_SPARE * sizeof(uint16_t));
    for (int y = 0; y < height; y++)
        up->down[y] = taps_at(y, height, up->rows);
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    rf_pool_run(pool, widen_row, up, up->rows);
    rf_pool_run(pool, fill_rows, up, up->rows + 1);
    rf_pool_run(pool, median_rows, up, (height + BAND - 1) / BAND);
}
