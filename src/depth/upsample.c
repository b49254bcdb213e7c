#include "depth/upsample.h"

#include <stdlib.h>
#include <string.h>

enum {
    PAD = 2,              /* samples beyond the map's border, repeated */
    STEP = 65535 / 24,    /* largest one within a surface */
    BAND = 16,            /* rows of a work item */
    RUN = 8,              /* most columns and rows of pixels that are looked at together */
    CHUNK = 256,          /* pixels that are settled together */
    SLICE = 128,          /* pixels whose colours are taken together */
    QUARTER = 2,          /* shift of colours: sums of three differences then fit */
    KINDS = 8,            /* of spans that are remembered */
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
    int weight[RF_TAPS], sum = 0, left = 32768, greatest = 0;

    for (int i = 0; i < RF_TAPS; i++) {
        weight[i] = mean_weight((int)(at - ((int64_t)taps.first + i) * 256));
        sum += weight[i];
        taps.near_by[i] = nearness(at - ((int64_t)taps.first + i) * 256);
    }
    taps.middle = (int16_t)((at - ((int64_t)taps.first + 1) * 256 - 128) * 128);
    for (int i = 0; i < RF_TAPS; i++) {
        taps.share[i] = (int16_t)(((int64_t)weight[i] << 15) / sum);
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
            up->colour[c][y * up->colour_stride + x] = (uint8_t)(p[c] >> QUARTER);
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

    (void)worker;
    up->kernels->widen4(up->wide + y * up->wide_stride, up->coarse + y * up->coarse_stride,
                        up->across, up->photo->width);
}

/* Where pixels of a span lie among the samples, for those that have been looked at last. */
struct lies {
    struct rf_lie lie[KINDS];
    int alike[KINDS], x[KINDS];
};

/* What a worker needs for rows of pixels between the same samples. */
struct patch {
    const struct rf_upsampler *up;
    int row;    /* the first of the taps */
    int y0, y1; /* rows of pixels, at most RUN */
    int bytes;  /* of a pixel */
    int ready;  /* colours of the columns before are in `colour` */
    int from;   /* the first of them */
    uint8_t colour[3][RUN][SLICE + RUN];
    struct rf_parts parts;
    struct rf_cell cell;
    struct lies lies;
    uint16_t near_disparity[RF_AROUND][RF_AROUND]; /* for windows at the border */
    uint8_t near_colour[3][RF_AROUND][RF_AROUND], near_trust[RF_AROUND][RF_AROUND];
};

/* The colours of n pixels from column x on, a row after the other. */
static void collect(uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], struct patch *patch, int x, int n)
{
    const struct refocus_image *photo = patch->up->photo;
    const int rows = patch->y1 - patch->y0;

    if (x < patch->from || x + n > patch->ready) {
        const int left = photo->width - x;

        patch->from = x;
        patch->ready = x + (left < SLICE ? left : SLICE);
        for (int y = patch->y0; y < patch->y1; y++) {
            uint8_t *const out[3] = {patch->colour[0][y - patch->y0],
                                     patch->colour[1][y - patch->y0],
                                     patch->colour[2][y - patch->y0]};

            patch->up->kernels->quarter(
                out, photo->plane[0] + y * photo->stride[0] + (ptrdiff_t)x * patch->bytes,
                patch->bytes, patch->ready - x);
        }
    }
    for (int c = 0; c < 3; c++) { /* copies of 8 cost less than copies of n */
        for (int j = 0; j < rows; j++)
            memcpy(colour[c] + j * n, &patch->colour[c][j][x - patch->from], RUN);
        memset(colour[c] + rows * n, colour[c][0], RF_BATCH_SPARE);
    }
}

static const struct rf_lie *lie_of(struct patch *patch, int cell, int x, int n)
{
    const struct rf_upsampler *up = patch->up;
    const struct rf_span *span = &up->span[cell];
    const int kind = span->alike % KINDS, off = x - span->begin;
    struct rf_lie *lie = &patch->lies.lie[kind];

    if (patch->lies.alike[kind] == span->alike && patch->lies.x[kind] == off)
        return lie;
    patch->lies.alike[kind] = span->alike;
    patch->lies.x[kind] = off;
    for (int y = patch->y0, at = 0; y < patch->y1; y++)
        for (int i = 0; i < n; i++, at++) {
            for (int t = 0; t < RF_TAP_COUNT; t++)
                lie->near_by[t][at] =
                    (uint16_t)((uint32_t)up->across[x + i].near_by[t % RF_TAPS] *
                                   up->down[y].near_by[t / RF_TAPS] >> 16);
            lie->x[at] = up->across[x + i].middle;
            lie->y[at] = up->down[y].middle;
        }
    return lie;
}

/* n elements of one or two bytes, at most 8 and often 4 or more. */
static inline void put(void *to, const void *from, int n, int size)
{
    if (n >= 4) {
        memcpy(to, from, 4 * (size_t)size);
        memcpy((char *)to + (n - 4) * size, (const char *)from + (n - 4) * size,
               4 * (size_t)size);
    } else {
        memcpy(to, from, (size_t)(n * size));
    }
}

/* The 8 x 8 samples around those from (x, y) on; at the border they are repeated. */
static struct rf_window window_at(struct patch *patch, int x, int y)
{
    const struct rf_upsampler *up = patch->up;
    struct rf_window window = {.stride = RF_AROUND, .colour_stride = RF_AROUND,
                               .trust_stride = RF_AROUND};

    if (x >= 0 && x + RF_TAPS <= up->columns && y >= 0 && y + RF_TAPS <= up->rows) {
        window.stride = up->coarse_stride;
        window.colour_stride = up->colour_stride;
        window.trust_stride = up->trust_stride;
        window.disparity = up->coarse + (y - 2) * up->coarse_stride + x - 2;
        for (int c = 0; c < 3; c++)
            window.colour[c] = up->colour[c] + (y - 2) * up->colour_stride + x - 2;
        if (up->confidence)
            window.trust = up->trust + (y - 2) * up->trust_stride + x - 2;
        return window;
    }
    for (int j = 0; j < RF_AROUND; j++)
        for (int i = 0; i < RF_AROUND; i++) {
            const int u = clamp(x - 2 + i, up->columns - 1), v = clamp(y - 2 + j, up->rows - 1);

            patch->near_disparity[j][i] = up->coarse[v * up->coarse_stride + u];
            for (int c = 0; c < 3; c++)
                patch->near_colour[c][j][i] = up->colour[c][v * up->colour_stride + u];
            if (up->confidence)
                patch->near_trust[j][i] = up->trust[v * up->trust_stride + u];
        }
    window.disparity = patch->near_disparity[0];
    for (int c = 0; c < 3; c++)
        window.colour[c] = patch->near_colour[c][0];
    window.trust = up->confidence ? patch->near_trust[0] : NULL;
    return window;
}

/* Pixels of a cell, whose taps are in column `at` of the parts. */
static void fill_cell(struct patch *patch, int cell, int at)
{
    const struct rf_upsampler *up = patch->up;
    const struct rf_window window = window_at(patch, cell - PAD, patch->row);
    const int x1 = up->span[cell + 1].begin, rows = patch->y1 - patch->y0;

    up->kernels->find_surfaces(&patch->cell, &window, &patch->parts, at);
    for (int x = up->span[cell].begin; x < x1; x += RUN) {
        const int n = x1 - x < RUN ? x1 - x : RUN;
        uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], sure[RF_BATCH];
        uint16_t result[RF_BATCH];

        collect(colour, patch, x, n);
        up->kernels->surface(result, sure, &patch->cell, &window, lie_of(patch, cell, x, n),
                             colour, rows * n);
        for (int j = 0; j < rows; j++) {
            put(up->raw + (patch->y0 + j) * up->raw_stride + x, result + j * n, n, 2);
            put(up->sure + (patch->y0 + j) * up->sure_stride + x, sure + j * n, n, 1);
        }
    }
}

/* The rough cells among the n from the first-th on. */
static void fill_cells(struct patch *patch, int first, int n)
{
    const struct rf_upsampler *up = patch->up;
    const uint16_t *row[RF_TAPS];
    const uint8_t *trust[RF_TAPS] = {NULL};
    uint8_t rough[RF_CELLS];

    for (int j = 0; j < RF_TAPS; j++) {
        row[j] = up->coarse + (patch->row + j) * up->coarse_stride + first - PAD;
        if (up->confidence)
            trust[j] = up->trust + (patch->row + j) * up->trust_stride + first - PAD;
    }
    if (!up->kernels->rough(rough, row, trust, STEP, n))
        return;
    up->kernels->part(&patch->parts, row, n);
    for (int i = 0; i < n; i++)
        if (rough[i] && up->span[first + i].begin < up->span[first + i + 1].begin)
            fill_cell(patch, first + i, i);
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
    const int first = item - PAD, width = up->photo->width, cells = up->columns + 1;
    const int y0 = row_of(up, first), y1 = row_of(up, first + 1);
    const uint16_t *wide[RF_TAPS];
    struct patch patch;

    (void)worker;
    patch.up = up;
    patch.row = first;
    patch.bytes = refocus_format_bytes(up->photo->format);
    for (int i = 0; i < RF_TAPS; i++)
        wide[i] = up->wide + clamp(first + i, up->rows - 1) * up->wide_stride;
    for (int y = y0; y < y1 && !rf_run_cancelled(up->run); y++) {
        uint16_t share[RF_TAPS];

        for (int i = 0; i < RF_TAPS; i++)
            share[i] = (uint16_t)(2 * up->down[y].share[i]);
        up->kernels->blend4(up->raw + y * up->raw_stride, wide, share, width);
        memset(up->sure + y * up->sure_stride, 255, (size_t)width);
    }
    for (patch.y0 = y0; patch.y0 < y1; patch.y0 = patch.y1) {
        patch.y1 = patch.y0 + RUN < y1 ? patch.y0 + RUN : y1;
        patch.from = patch.ready = 0;
        for (int i = 0; i < KINDS; i++)
            patch.lies.alike[i] = -1;
        for (int i = 0; i < cells && !rf_run_cancelled(up->run); i += RF_CELLS)
            fill_cells(&patch, i, cells - i < RF_CELLS ? cells - i : RF_CELLS);
    }
    for (int y = y0; y < y1; y++) {
        uint16_t *row = up->raw + y * up->raw_stride;

        row[-1] = row[0];
        row[width] = row[width - 1];
    }
}

static void settle_rows(void *context, int item, int worker)
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
                up->kernels->lean3(out + x, before + x, row + x, after + x, sure + x, n);
            else
                memcpy(out + x, row + x, (size_t)n * sizeof *out);
        }
    }
}

static bool lie_alike(const struct rf_upsampler *up, int a, int b)
{
    const int from = up->span[a].begin, n = up->span[a + 1].begin - from;

    if (up->span[b + 1].begin - up->span[b].begin != n)
        return false;
    for (int i = 0; i < n; i++)
        if (up->across[from + i].middle != up->across[up->span[b].begin + i].middle)
            return false;
    return true;
}

/* Spans whose pixels lie the same way are told to have the first one's: of the last few. */
static void find_spans(struct rf_upsampler *up)
{
    int x = 0;

    for (int i = 0; i < up->columns + 2; i++) {
        while (x < up->photo->width && up->across[x].first < i - PAD)
            x++;
        up->span[i].begin = x;
    }
    for (int i = 0; i <= up->columns; i++) {
        up->span[i].alike = i;
        for (int k = i - 1; k >= 0 && k >= i - KINDS; k--) {
            if (lie_alike(up, k, i)) {
                up->span[i].alike = up->span[k].alike;
                break;
            }
        }
    }
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool)
{
    const int width = up->photo->width, height = up->photo->height;

    up->run = pool->run;
    for (int x = 0; x < width; x++)
        up->across[x] = taps_at(x, width, up->columns);
    find_spans(up);
    for (int y = 0; y < height; y++)
        up->down[y] = taps_at(y, height, up->rows);
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    rf_pool_run(pool, widen_row, up, up->rows);
    rf_pool_run(pool, fill_rows, up, up->rows + 1);
    rf_pool_run(pool, settle_rows, up, (height + BAND - 1) / BAND);
}
