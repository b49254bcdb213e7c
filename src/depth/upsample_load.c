/* upsample_load.c: loads the samples of a map that is brought to the photo's size, and what the
 * photo shows there. */
#include "depth/upsample.h"

#include <string.h>

#include "depth/dequantise.h"
#include "image/disparity_map.h"
#include "support/compare.h"

enum {
    PAD = RF_UPSAMPLE_PAD,
    QUARTER = 2, /* shift of colours: sums of three differences then fit */
};

/* The column or row, of `size`, that the i-th of `samples` lies on. */
static int place(int i, int samples, int size)
{
    return rf_middle_of(rf_clamp(i, 0, samples - 1), samples, size);
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
        .spare = {up->in_strips ? up->spare : up->wide, up->in_strips ? up->out : up->settled},
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

void rf_upsample_load(struct rf_upsampler *up, struct rf_pool *pool)
{
    struct walk walk = walk_from_0(up->columns, up->photo->width);

    for (int i = 0; i < up->columns; i++, walk_on(&walk))
        up->span[i].shown = (int32_t)walk.at;
    rf_pool_run(pool, load_row, up, up->rows + 2 * PAD);
    dequantise_samples(up, pool);
}
