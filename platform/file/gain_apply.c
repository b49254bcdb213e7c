/* gain_apply.c: the light that a base rendition and its gain map stand for.
 *
 * A map is smaller than its photo, mostly a quarter of its sides: a sample is the gain of the mean
 * of a block of pixels. Interpolated, the gain of a highlight of few pixels would fall on what is
 * beside it, and the highlight would have too little. But what the map adds was lost where the
 * photo clips. So gains are interpolated without those of blocks that clip, and the light that is
 * missing then in the mean of such a block goes to its clipped values, evenly; by a map for all
 * channels it goes to its clipped pixels, which keep their hue. */
#include "gain_apply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "half.h"
#include "tone.h"

enum {
    FRACTIONS = 1024,
    STOPS = 32,      /* gains are within so many, either way */
    ROWS = 4,        /* rows of blocks that are held: one before that of a pixel, two behind it */
    UNCLIPPED = 240, /* codes up to here have kept their light */
    CLIPPED = 252,   /* codes from here on are clipped, but for the noise of JPEG */
};

/* A block of the photo: the pixels of which a sample of the map is the mean. */
struct block {
    float light[3];   /* sum of base light; then of the light by interpolated gains */
    float clipped[3]; /* sum of shares_of() */
    float gain[3];    /* log2, to be interpolated */
    float more[3];    /* light that a share of 1 gets */
    int pixels;
};

/* Where a column of the photo lies in the map. */
struct column {
    int block, first, second; /* block that it is in; samples before and behind it */
    float part;               /* part of the way between the samples */
};

struct work {
    const struct rf_gain_map *map;
    const struct refocus_image *base;
    struct block *blocks; /* ROWS rows; NULL: blocks have one pixel, or none */
    int measured, y;      /* rows of blocks, and of pixels, that have been measured */
    struct column *columns;
    float (*gain)[3];          /* a row of gains, interpolated between rows of blocks */
    float light[256];          /* base light of each code */
    float clipped[256];        /* 1 where a code is clipped, less where it may be */
    float exp2[FRACTIONS + 1]; /* 2^(i / FRACTIONS) */
    float whole[2 * STOPS];    /* 2^(i - STOPS) */
};

/* 2^gain, within 2^-21 of it: offsets of many times white leave little of it. */
static float power_of(const struct work *work, float gain)
{
    const int whole = (int)(gain + STOPS);
    const float at = (gain - (float)(whole - STOPS)) * FRACTIONS;
    const int below = (int)at;
    const float power = work->exp2[below];

    return (power + (at - (float)below) * (work->exp2[below + 1] - power)) * work->whole[whole];
}

static float other_light(const struct work *work, int c, float base, float gain)
{
    const struct rf_gain_values *const v = &work->map->values;

    return (base + (float)v->base_offset[c]) * power_of(work, gain) - (float)v->other_offset[c];
}

/* Where pixel `at` of `size` lies among `samples`: the sample before it, and how far behind that.
 */
static int place(int at, int size, int samples, float *part)
{
    const double x = (at + 0.5) * samples / size - 0.5;
    const int first = x <= 0 ? 0 : x >= samples - 1 ? samples - 1 : (int)x;

    *part = x <= 0 ? 0 : (float)(x - first);
    return first;
}

static int block_at(int at, int size, int samples)
{
    return (int)((at + 0.5) * samples / size);
}

static struct block *row_of(const struct work *work, int y)
{
    return work->blocks + (size_t)(y % ROWS) * (size_t)work->map->samples.width;
}

static const uint8_t *base_row(const struct work *work, int y)
{
    return work->base->plane[0] + y * work->base->stride[0];
}

/* The gain of a block's own sample, log2. */
static float own_gain(const struct work *work, int x, int y, int c)
{
    const struct rf_raster *const samples = &work->map->samples;
    const int at = samples->channels * x + (samples->channels == 3 ? c : 0);

    return work->map->gain[c][samples->pixels[(size_t)y * rf_raster_stride(samples) + (size_t)at]];
}

/* The share that each channel of a pixel has in the light that clipping took from a block. */
static void shares_of(const struct work *work, const uint8_t code[3], float share[3])
{
    float most = 0;

    for (int c = 0; c < 3; c++) {
        share[c] = work->clipped[code[c]];
        most = share[c] > most ? share[c] : most;
    }
    for (int c = 0; c < 3 && work->map->samples.channels == 1; c++)
        share[c] = most * work->light[code[c]];
}

/* Sum up what the next row of blocks has. */
static void measure(struct work *work)
{
    const int width = work->base->width, height = work->base->height;
    const struct rf_raster *const samples = &work->map->samples;
    struct block *const row = row_of(work, work->measured);

    memset(row, 0, (size_t)samples->width * sizeof *row);
    for (; work->y < height && block_at(work->y, height, samples->height) == work->measured;
         work->y++) {
        const uint8_t *code = base_row(work, work->y);

        for (int x = 0; x < width; x++) {
            struct block *const block = row + work->columns[x].block;
            float share[3];

            block->pixels++;
            shares_of(work, code, share);
            for (int c = 0; c < 3; c++, code++) {
                block->light[c] += work->light[*code];
                block->clipped[c] += share[c];
            }
        }
    }
    work->measured++;
}

/* Whether the sample of a block may hold light that clipping took in a channel: of one for all
 * channels, in any. */
static bool clips(const struct work *work, const struct block *block, int c)
{
    const float least = (float)block->pixels / 64;

    if (work->map->samples.channels == 3)
        return block->clipped[c] > least;
    return block->clipped[0] > least || block->clipped[1] > least || block->clipped[2] > least;
}

/* The least gain around a block that clips, of those that do not if there are any. */
static float gain_around(const struct work *work, int x, int y, int c)
{
    const struct rf_raster *const samples = &work->map->samples;
    float least[2] = {INFINITY, INFINITY};

    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < samples->height; j++) {
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < samples->width; i++) {
            float *const to = &least[clips(work, row_of(work, j) + i, c)];
            const float gain = own_gain(work, i, j, c);

            *to = gain < *to ? gain : *to;
        }
    }
    return least[0] < INFINITY ? least[0] : least[1];
}

static void set_gains(const struct work *work, int y)
{
    for (int x = 0; x < work->map->samples.width; x++) {
        struct block *const block = row_of(work, y) + x;

        for (int c = 0; c < 3; c++) {
            const float own = own_gain(work, x, y, c);

            block->gain[c] = clips(work, block, c) ? fminf(own, gain_around(work, x, y, c)) : own;
        }
    }
}

static float gain_of(const struct work *work, int x, int y, int c)
{
    return work->blocks ? row_of(work, y)[x].gain[c] : own_gain(work, x, y, c);
}

static void blend_rows(const struct work *work, int y)
{
    const struct rf_raster *const samples = &work->map->samples;
    float part;
    const int first = place(y, work->base->height, samples->height, &part);
    const int second = first + 1 < samples->height ? first + 1 : first;

    for (int x = 0; x < samples->width; x++) {
        for (int c = 0; c < 3; c++) {
            const float gain = gain_of(work, x, first, c);

            work->gain[x][c] = gain + part * (gain_of(work, x, second, c) - gain);
        }
    }
}

/* The light of a row by interpolated gains, and what clipped values get beside it: to the picture,
 * or, where light is NULL, to the sums of their blocks. */
static void apply_row(const struct work *work, int y, uint16_t *light)
{
    const int width = work->base->width;
    struct block *const row =
        work->blocks ? row_of(work, block_at(y, work->base->height, work->map->samples.height))
                     : NULL;
    const uint8_t *code = base_row(work, y);

    blend_rows(work, y);
    for (int x = 0; x < width; x++, code += 3) {
        const struct column *const at = &work->columns[x];
        const float *const a = work->gain[at->first], *const b = work->gain[at->second];
        struct block *const block = row ? row + at->block : NULL;
        float share[3];

        shares_of(work, code, share);
        for (int c = 0; c < 3; c++) {
            const float other =
                other_light(work, c, work->light[code[c]], a[c] + at->part * (b[c] - a[c]));

            if (!light)
                block->light[c] += other;
            else
                light[3 * x + c] = rf_half_of(other + (block ? block->more[c] * share[c] : 0));
        }
    }
}

/* Sets what clipped values of a row of blocks get, of which pixels are in rows y0 to y1 - 1 of the
 * photo. */
static void share_out(const struct work *work, int row, int y0, int y1)
{
    struct block *const blocks = row_of(work, row);
    const int count = work->map->samples.width;
    bool any = false;

    for (int x = 0; x < count; x++) {
        for (int c = 0; c < 3; c++) {
            struct block *const block = blocks + x;
            const float pixels = (float)block->pixels;

            if (block->clipped[c] > 0) {
                block->more[c] = pixels * other_light(work, c, block->light[c] / pixels,
                                                      own_gain(work, x, row, c));
                any = true;
            }
            block->light[c] = 0;
        }
    }
    for (int y = y0; any && y < y1; y++)
        apply_row(work, y, NULL);
    for (int x = 0; any && x < count; x++) {
        for (int c = 0; c < 3; c++) {
            struct block *const block = blocks + x;
            const float lacks = block->more[c] - block->light[c];

            /* No share gets more than the block: what little is missing may be rounding. */
            block->more[c] =
                lacks > 0 && block->clipped[c] > 0 ? lacks / fmaxf(block->clipped[c], 1) : 0;
        }
    }
}

/* Brings the rows of blocks up to two behind this one; their gains up to one behind. */
static void advance(struct work *work, int row)
{
    const int rows = work->map->samples.height;

    while (work->measured < rows && work->measured <= row + 2) {
        measure(work);
        if (work->measured > 1)
            set_gains(work, work->measured - 2);
    }
    if (work->measured == rows)
        set_gains(work, rows - 1);
}

static void apply(struct work *work, uint16_t *light)
{
    const int height = work->base->height, rows = work->map->samples.height;
    int end;

    for (int y = 0; y < height; y = end) {
        const int row = block_at(y, height, rows);

        for (end = y + 1; end < height && block_at(end, height, rows) == row;)
            end++;
        if (work->blocks) {
            advance(work, row);
            share_out(work, row, y, end);
        }
        for (int own = y; own < end; own++)
            apply_row(work, own, light + (size_t)own * 3 * (size_t)work->base->width);
    }
}

static void set_curves(struct work *work)
{
    for (int i = 0; i < 256; i++) {
        const float clipped = (float)(i - UNCLIPPED) / (CLIPPED - UNCLIPPED);

        work->light[i] = rf_tone_light(i);
        work->clipped[i] = clipped < 0 ? 0 : clipped > 1 ? 1 : clipped;
    }
    for (int i = 0; i <= FRACTIONS; i++)
        work->exp2[i] = exp2f((float)i / FRACTIONS);
    for (int i = 0; i < 2 * STOPS; i++)
        work->whole[i] = exp2f((float)(i - STOPS));
}

static void set_columns(const struct work *work)
{
    const int width = work->base->width, samples = work->map->samples.width;

    for (int x = 0; x < width; x++) {
        struct column *const at = &work->columns[x];

        at->block = block_at(x, width, samples);
        at->first = place(x, width, samples, &at->part);
        at->second = at->first + 1 < samples ? at->first + 1 : at->first;
    }
}

int rf_gain_apply(const struct rf_gain_map *map, const struct refocus_image *base, uint16_t *light)
{
    const size_t samples = (size_t)map->samples.width;
    const bool spreads = map->samples.width < base->width && map->samples.height < base->height;
    struct work work = {.map = map, .base = base};
    int status = REFOCUS_ERR_MEMORY;

    work.blocks = spreads ? calloc(ROWS * samples, sizeof *work.blocks) : NULL;
    work.gain = malloc(samples * sizeof *work.gain);
    work.columns = malloc((size_t)base->width * sizeof *work.columns);
    if ((work.blocks || !spreads) && work.gain && work.columns) {
        set_curves(&work);
        set_columns(&work);
        apply(&work, light);
        status = REFOCUS_OK;
    }
    free(work.blocks);
    free(work.gain);
    free(work.columns);
    return status;
}
