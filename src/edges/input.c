/* input.c: takes in the photo and the map whose edges go where the photo has them. */
#include "edges/input.h"

#include <stdlib.h>
#include <string.h>

#include "depth/dequantise.h"
#include "depth/impulses.h"
#include "depth/noise.h"
#include "image/format.h"
#include "image/disparity_map.h"
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
    const uint8_t *in = photo->plane[0] + (ptrdiff_t)y * k * photo->stride[0];

    (void)worker;
    for (int c = 0; c < 3; c++) {
        uint8_t *restrict out = e->colour[c] + y * e->stride;
        const uint8_t *restrict code = in + at[c];

        for (int x = 0; x < e->width && k == 1; x++, code += order.bytes)
            out[x] = *code;
        for (int x = 0; x < e->width && k > 1; x++, code += (ptrdiff_t)k * order.bytes)
            out[x] =
                mean_code(code, photo->stride[0], order.bytes, rf_smaller(k, photo->width - x * k),
                          rf_smaller(k, photo->height - y * k));
    }
}

void rf_load_edge_photo(struct rf_edge_job *job)
{
    rf_pool_run(job->edges.pool, load_photo_row, job, job->edges.height);
}

/* ----- map ----- */

static void load_samples(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct refocus_disparity *map = job->map;
    const void *row = rf_map_row(map, rf_middle_of(y, job->rows, map->height));
    uint16_t *out = job->sample.at + y * job->sample.stride;
    const bool all = job->columns == map->width;

    (void)worker;
    if (all && map->bits == 16) {
        memcpy(out, row, (size_t)job->columns * sizeof *out);
        return;
    }
    for (int x = 0; x < job->columns; x++)
        out[x] = rf_map_sample(map, row, all ? x : rf_middle_of(x, job->columns, map->width));
}

/* Centres lie at (i + 1/2) / size of both rasters. */
static struct rf_sample_place place_of(int i, int size, int samples)
{
    const int64_t at = ((2 * (int64_t)i + 1) * samples * 128) / size - 128;
    const int64_t inside = at < 0 ? 0 : at;
    const int first = rf_smaller((int)(inside >> 8), samples - 1);

    return (struct rf_sample_place){first, rf_smaller(first + 1, samples - 1), (int)(inside & 255)};
}

/* A row of the map by straight lines between its samples. */
static void interpolate(const struct rf_edge_job *job, uint16_t *out, int y)
{
    const int width = job->edges.width;
    const struct rf_sample_place down = place_of(y, job->edges.height, job->rows);
    const uint16_t *above = job->sample.at + down.first * job->sample.stride;
    const uint16_t *below = job->sample.at + down.next * job->sample.stride;

    if (width == job->columns && down.share == 0) {
        memcpy(out, above, (size_t)width * sizeof *out);
        return;
    }
    for (int x = 0; x < width; x++) {
        const struct rf_sample_place across = job->column[x];
        const int64_t high =
            above[across.first] * (256 - across.share) + above[across.next] * across.share;
        const int64_t low =
            below[across.first] * (256 - across.share) + below[across.next] * across.share;

        out[x] = (uint16_t)((high * (256 - down.share) + low * down.share + 32768) >> 16);
    }
}

static void enlarge_row(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct rf_edges *e = &job->edges;

    (void)worker;
    interpolate(job, e->map + y * e->stride, y);
}

void rf_load_edge_map(struct rf_edge_job *job)
{
    struct rf_edges *e = &job->edges;
    const struct rf_disparity_q16 spare[2] = {{e->far, e->stride}, {e->label, e->stride}};
    const struct rf_dequantiser d = {
        .kernels = e->kernels,
        .code = job->sample,
        .spare = {spare[0], spare[1]},
        .width = job->columns,
        .height = job->rows,
        .step = rf_code_step(job->map),
    };

    for (int x = 0; x < e->width; x++)
        job->column[x] = place_of(x, e->width, job->columns);
    rf_pool_run(e->pool, load_samples, job, job->rows);
    job->impulses = job->enlarged ? 0 : rf_impulses_of(job->sample, job->columns, job->rows);
    if (job->impulses)
        rf_remove_impulses(job->sample, spare[0], job->columns, job->rows, e->pool);
    job->noise = rf_noise_of(job->sample, job->columns, job->rows, d.step);
    if (job->noise)
        rf_denoise(e->kernels, job->sample, spare, job->columns, job->rows, job->noise, e->pool);
    else if (d.step)
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
    job->sample.at = own.near;
    rf_find_steepest(&own);
    return rf_measure_softness(&own, RF_SOFTNESS_PERCENTILE);
}

/* Writes how many pixels of a row differ to the place of its first sample. */
static void count_changes(void *context, int y, int worker)
{
    const struct rf_edge_job *job = context;
    const struct rf_edges *e = &job->edges;
    const uint16_t *map = e->map + y * e->stride;
    uint16_t *was = e->spare + y * e->stride, changed = 0;

    (void)worker;
    interpolate(job, was, y);
    for (int x = 0; x < e->width; x++)
        changed = (uint16_t)(changed + (abs(map[x] - was[x]) >= CHANGED));
    was[0] = changed;
}

float rf_share_changed(struct rf_edge_job *job)
{
    const struct rf_edges *e = &job->edges;
    int64_t changed = 0;

    job->sample.at = e->near;
    rf_pool_run(e->pool, load_samples, job, job->rows);
    rf_pool_run(e->pool, count_changes, job, e->height);
    for (int y = 0; y < e->height; y++)
        changed += e->spare[y * e->stride];
    return (float)changed / ((float)e->width * (float)e->height);
}
