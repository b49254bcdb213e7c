#include "depth/upsample.h"

#include <stdlib.h>
#include <string.h>

enum {
    PAD = 2,              /* samples beyond the map's border, repeated */
    STEP = 65535 / 24,    /* largest one within a surface */
    SURFACE = 65535 / 12, /* samples closer than this are of one surface */
    BAND = 16,            /* rows of a work item */
};

/* Quadratic fall-off over two samples: (2 - |t|)^2 / 4 in Q15, t in Q8. */
static int nearness(int t)
{
    const int left = 512 - abs(t);

    return left <= 0 ? 0 : (left * left) >> 3;
}

/* Pixel centres at (x + 1/2) / size of both rasters. */
static struct rf_taps taps_at(int x, int size, int samples)
{
    const int64_t at = ((2 * (int64_t)x + 1) * samples * 128) / size - 128; /* Q8 */
    struct rf_taps taps = {.first = (int32_t)((at + 256) >> 8) - 2};
    int sum = 0, left = 65536, greatest = 0;

    for (int i = 0; i < RF_TAPS; i++) {
        taps.near_by[i] = (uint16_t)nearness((int)(at - ((int64_t)taps.first + i) * 256));
        sum += taps.near_by[i];
    }
    for (int i = 0; i < RF_TAPS; i++) {
        taps.share[i] = (uint16_t)(((int64_t)taps.near_by[i] << 16) / sum);
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
static void look(struct rf_cell *cell, const struct rf_upsampler *up, int x, int y,
                 uint16_t d[RF_SAMPLES])
{
    const struct refocus_image *photo = up->photo;
    const int bytes = refocus_format_bytes(photo->format);

    for (int i = 0; i < RF_SAMPLES; i++) {
        const int sx = x + i % RF_TAPS, sy = y + i / RF_TAPS;
        const int px = place(sx, up->columns, photo->width);
        const int py = place(sy, up->rows, photo->height);
        const uint8_t *p = photo->plane[0] + py * photo->stride[0] + (ptrdiff_t)px * bytes;

        d[i] = up->coarse[sy * up->coarse_stride + sx];
        for (int c = 0; c < 3; c++)
            cell->colour[c][i] = p[c];
        cell->trust[i] = 65535;
        if (up->confidence) {
            const uint8_t *row = up->confidence +
                                 place(sy, up->rows, up->map->height) * up->confidence_stride;
            const int trust = row[place(sx, up->columns, up->map->width)];

            cell->trust[i] = (uint16_t)(trust < 1 ? 16 : trust * 257);
        }
    }
}

/* Every longest run of sorted samples no longer than SURFACE. */
static void find_windows(struct rf_cell *cell, const uint16_t d[RF_SAMPLES])
{
    uint16_t sorted[RF_SAMPLES];
    int last_end = 0;

    for (int i = 0; i < RF_SAMPLES; i++) {
        int at = i;

        for (; at > 0 && sorted[at - 1] > d[i]; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = d[i];
    }
    cell->windows = 0;
    for (int begin = 0, end = 0; begin < RF_SAMPLES && last_end < RF_SAMPLES; begin++) {
        while (end < RF_SAMPLES && sorted[end] - sorted[begin] <= SURFACE)
            end++;
        if (end > last_end) {
            struct rf_window *window = &cell->window[cell->windows++];

            window->low = sorted[begin];
            for (int i = 0; i < RF_SAMPLES; i++) {
                const int above = d[i] - window->low;
                const int in = above >= 0 && above <= SURFACE;

                window->in[i] = in ? 0xffff : 0;
                window->above[i] = (int16_t)(in ? above : 0);
            }
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

/* Pixels x0 to x1 - 1 of rows y0 to y1 - 1, which lie between the same samples. */
static void fill_cell(const struct rf_upsampler *up, int x0, int x1, int y0, int y1,
                      const struct rf_taps *down)
{
    const struct refocus_image *photo = up->photo;
    const int bytes = refocus_format_bytes(photo->format);
    struct rf_cell cell;
    uint16_t d[RF_SAMPLES];

    look(&cell, up, up->across[x0].first, down->first, d);
    find_windows(&cell, d);
    for (int y = y0; y < y1; y++) {
        const struct rf_taps taps = taps_at(y, photo->height, up->rows);
        const uint8_t *p =
            photo->plane[0] + y * photo->stride[0] + (ptrdiff_t)x0 * bytes;
        const uint8_t *const colour[3] = {p, p + 1, p + 2};
        uint16_t near_by[BAND][RF_TAPS];

        for (int x = x0; x < x1; x += BAND) {
            const int n = x1 - x < BAND ? x1 - x : BAND;
            const uint8_t *const at[3] = {colour[0] + (x - x0) * bytes,
                                          colour[1] + (x - x0) * bytes,
                                          colour[2] + (x - x0) * bytes};

            for (int i = 0; i < n; i++)
                memcpy(near_by[i], up->across[x + i].near_by, sizeof near_by[i]);
            up->kernels->cluster(up->raw + y * up->raw_stride + x, &cell,
                                 (const uint16_t(*)[RF_TAPS])near_by, taps.near_by, at, bytes,
                                 n);
        }
    }
}

/* The first row whose taps begin at `first` or later. */
static int row_of(const struct rf_upsampler *up, int first)
{
    const int height = up->photo->height;
    int low = 0, high = height;

    while (low < high) {
        const int middle = low + (high - low) / 2;

        if (taps_at(middle, height, up->rows).first < first)
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
    const struct rf_taps taps = taps_at(y0, up->photo->height, up->rows);
    for (int i = 0; i < RF_TAPS; i++) {
        coarse[i] = up->coarse + (first + i) * up->coarse_stride - PAD;
        wide[i] = up->wide + clamp(first + i, up->rows - 1) * up->wide_stride;
    }
    up->kernels->steps4(across - PAD, down - PAD, coarse, up->columns + 2 * PAD - 1);
    down[up->columns + PAD - 1] = down[up->columns + PAD - 2];
    for (int y = y0; y < y1; y++)
        up->kernels->blend4(up->raw + y * up->raw_stride, wide,
                            taps_at(y, up->photo->height, up->rows).share, width);
    for (int x0 = 0, x1; x0 < width; x0 = x1) {
        for (x1 = x0 + 1; x1 < width && up->across[x1].first == up->across[x0].first;)
            x1++;
        if (!is_smooth(up, across, down, up->across[x0].first, first))
            fill_cell(up, x0, x1, y0, y1, &taps);
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

    for (int x = 0; x < width; x++)
        up->across[x] = taps_at(x, width, up->columns);
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    rf_pool_run(pool, widen_row, up, up->rows);
    rf_pool_run(pool, fill_rows, up, up->rows + 1);
    rf_pool_run(pool, median_rows, up, (height + BAND - 1) / BAND);
}
