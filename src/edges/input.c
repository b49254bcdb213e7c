/* input.c: takes in the photo and the map whose edges go where the photo has them. */
#include "edges/input.h"

#include <stdlib.h>
#include <string.h>

#include "depth/dequantise.h"
#include "image/format.h"
#include "support/compare.h"

enum { CHANGED = 257 }; /* a code of 8 bits */

/* ----- photo ----- */

/* The mean code of the pixels of a square, cut off at the sides of the photo. */
static uint8_t mean_code(const uint8_t *in, ptrdiff_t stride, int bytes, int width, int height)
{
    const int n = width * height;
    int64_t sum = n / 2;

    for (int v = 0; v < height; v++)
        for (int u = 0; u < width; u++)
            sum += in[v * stride + (ptrdiff_t)u * bytes];
    return (uint8_t)(sum / n);
}

static void load_photo_row(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct refocus_image *photo = job->photo;
    const struct rf_order order = rf_order_of(photo->format);
    const int at[3] = {order.r, order.g, order.b}, k = job->reduced;
    const struct rf_edges *e = &job->edges;

    (void)worker;
    for (int c = 0; c < 3; c++) {
        const uint8_t *in = photo->plane[0] + (ptrdiff_t)y * k * photo->stride[0] + at[c];
        uint8_t *out = e->colour[c] + y * e->stride;

        for (int x = 0; x < e->width; x++)
            out[x] = k == 1 ? in[(ptrdiff_t)x * order.bytes]
                            : mean_code(in + (ptrdiff_t)x * k * order.bytes, photo->stride[0],
                                        order.bytes, rf_smaller(k, photo->width - x * k),
                                        rf_smaller(k, photo->height - y * k));
    }
}

void rf_load_edge_photo(struct rf_edge_job *job)
{
    rf_pool_run(job->edges.pool, load_photo_row, job, job->edges.height);
}

/* ----- map ----- */

static uint16_t sample_at(const struct refocus_disparity *map, int x, int y)
{
    const uint8_t *row = (const uint8_t *)map->samples + y * map->stride;

    return (uint16_t)(map->bits == 16 ? ((const uint16_t *)row)[x] : row[x] * 257);
}

/* The sample in the middle of the i-th of n parts of `size`. */
static int middle_of(int i, int n, int size)
{
    return (int)((2 * (int64_t)i + 1) * size / (2 * (int64_t)n));
}

static void load_samples(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct refocus_disparity *map = job->map;
    const int row = middle_of(y, job->rows, map->height);

    (void)worker;
    for (int x = 0; x < job->columns; x++)
        job->sample.at[y * job->sample.stride + x] =
            sample_at(map, middle_of(x, job->columns, map->width), row);
}

/* A place among samples: between `first` and the one at `next`, in Q8. */
struct place {
    int first, next, share;
};

/* Centres lie at (i + 1/2) / size of both rasters. */
static struct place place_of(int i, int size, int samples)
{
    const int64_t at = ((2 * (int64_t)i + 1) * samples * 128) / size - 128;
    const int64_t inside = at < 0 ? 0 : at;
    const int first = rf_smaller((int)(inside >> 8), samples - 1);

    return (struct place){first, rf_smaller(first + 1, samples - 1), (int)(inside & 255)};
}

/* The map at a pixel, by straight lines between its samples. */
static uint16_t interpolate(const struct rf_edge_job *job, int x, int y)
{
    const struct place across = place_of(x, job->edges.width, job->columns);
    const struct place down = place_of(y, job->edges.height, job->rows);
    const uint16_t *above = job->sample.at + down.first * job->sample.stride;
    const uint16_t *below = job->sample.at + down.next * job->sample.stride;
    const int64_t high =
        above[across.first] * (256 - across.share) + above[across.next] * across.share;
    const int64_t low =
        below[across.first] * (256 - across.share) + below[across.next] * across.share;

    return (uint16_t)((high * (256 - down.share) + low * down.share + 32768) >> 16);
}

static void enlarge_row(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct rf_edges *e = &job->edges;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        e->map[y * e->stride + x] = interpolate(job, x, y);
}

void rf_load_edge_map(struct rf_edge_job *job)
{
    struct rf_edges *e = &job->edges;
    const struct rf_dequantiser d = {
        .kernels = e->kernels,
        .code = job->sample,
        .spare = {{e->far, e->stride}, {e->label, e->stride}},
        .width = job->columns,
        .height = job->rows,
        .step = rf_code_step(job->map),
    };

    rf_pool_run(e->pool, load_samples, job, job->rows);
    if (d.step)
        rf_dequantise(&d, e->pool);
    rf_pool_run(e->pool, enlarge_row, job, e->height);
}

double rf_softness_of_samples(struct rf_edge_job *job)
{
    struct rf_edges own = job->edges;

    own.width = job->columns;
    own.height = job->rows;
    job->sample.at = own.map;
    rf_pool_run(own.pool, load_samples, job, job->rows);
    rf_find_ramps(&own, (struct rf_ramp_limits){.steps = 16, .contrast = RF_EDGE_STEP});
    job->sample.at = own.near;
    return rf_measure_softness(&own);
}

float rf_share_changed(struct rf_edge_job *job)
{
    const struct rf_edges *e = &job->edges;
    int64_t changed = 0;

    job->sample.at = e->near;
    rf_pool_run(e->pool, load_samples, job, job->rows);
    for (int y = 0; y < e->height; y++)
        for (int x = 0; x < e->width; x++)
            changed += abs(e->map[y * e->stride + x] - interpolate(job, x, y)) >= CHANGED;
    return (float)changed / ((float)e->width * (float)e->height);
}
