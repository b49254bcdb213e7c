/* depth_edges.c: puts the edges of a caller's disparity map where the photo has them. */
#include <refocus/depth_edges.h>

#include <stdlib.h>
#include <string.h>

#include <refocus/depth.h>

#include "depth/dequantise.h"
#include "edges/edges.h"
#include "image/format.h"
#include "image/read.h"
#include "support/compare.h"

enum {
    MOST_ENLARGED = 4, /* the map is brought to at most so many times its size */
    CHANGED = 257,     /* a code of 8 bits */
};
/* Softer edges are ramps of several pixels, which show. An exact map has 0.4, with smooth
 * silhouettes 1; straight lines between samples two pixels apart make 1.2. */
static const double SOFT = 1.25;
/* Samples of a small map that were taken at points, as sensors do, have 0.4 at their own size;
 * means over areas mix two surfaces along edges and have 0.64 and more. */
static const double MIXED = 0.6;

struct job {
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    struct rf_edges edges;
    int reduced;                    /* the photo by so much */
    int columns, rows;              /* samples of the map that are used */
    struct rf_disparity_q16 sample; /* in the memory of near, until ramps are found */
    bool enlarged;
};

/* ----- memory ----- */

static void *take_plane(struct rf_arena *arena, const struct rf_edges *e, uint64_t size)
{
    return rf_arena_take(arena, (uint64_t)e->stride * ((uint64_t)e->height + 2), size);
}

/* Sets the pointers, or with arena->base == NULL only counts. Each plane has a border of a pixel,
 * so that all have the same stride. */
static void lay_out(struct rf_edges *e, struct rf_arena *arena)
{
    const uint64_t across = (uint64_t)rf_edge_blocks_across(e);
    const uint64_t blocks = across * (uint64_t)((e->height + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK);
    uint16_t **const planes[] = {&e->map,     &e->near,  &e->far, &e->label,
                                 &e->largest, &e->spare, &e->kept};
    int16_t **const slopes[] = {&e->gradient.x, &e->gradient.y};

    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++)
        *planes[i] = take_plane(arena, e, sizeof **planes[i]);
    for (size_t i = 0; i < sizeof slopes / sizeof *slopes; i++)
        *slopes[i] = take_plane(arena, e, sizeof **slopes[i]);
    for (int c = 0; c < 3; c++)
        e->colour[c] = take_plane(arena, e, 1);
    e->steepest = take_plane(arena, e, 1);
    e->is_wide = take_plane(arena, e, 1);
    e->range = rf_arena_take(arena, blocks, sizeof *e->range);
    e->rough = rf_arena_take(arena, blocks, 1);
    e->most_edges = (int)((int64_t)e->width * e->height / 8);
    e->edge = rf_arena_take(arena, (uint64_t)e->most_edges, sizeof *e->edge);
    rf_align_lay_out(e, arena);
    if (arena->base)
        e->map += e->stride + 1;
}

/* ----- photo and map ----- */

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

static void load_photo(void *context, int y, int worker)
{
    const struct job *job = context;
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
    const struct job *job = context;
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
static uint16_t interpolate(const struct job *job, int x, int y)
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
    const struct job *job = context;
    const struct rf_edges *e = &job->edges;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        e->map[y * e->stride + x] = interpolate(job, x, y);
}

/* Takes in the map: slopes in place of the steps of few codes, at the size that work is done at. */
static void load_map(struct job *job)
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

/* The softness of the samples as they are, in pixels of their own. */
static double softness_of_samples(struct job *job)
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

/* ----- order of the passes ----- */

/* Works on job->edges and leaves the result in its map; says whether it differs from the samples.
 */
static bool run(struct job *job, struct refocus_depth_edges_report *report)
{
    struct rf_edges *e = &job->edges;
    const double pixel = job->reduced;
    struct rf_ramp_limits limits = {.steps = 16, .contrast = RF_EDGE_STEP};
    struct rf_alignment found;
    double softness;
    bool soft;

    rf_find_ramps(e, limits);
    softness = rf_measure_softness(e);
    if (job->enlarged && softness < SOFT) /* straight lines between samples are ramps */
        softness = SOFT;
    soft = softness >= SOFT;
    /* A ramp of a Gaussian is 4 standard deviations long; one of a sharp map 2 or 3 pixels. */
    limits.steps = soft ? (int)(4 * softness + 2.5) : 3;
    limits.contrast = soft ? 2621 : 3932;
    limits.part = soft; /* ramps of a sharp map are mixed pixels */
    rf_find_ramps(e, limits);
    found = rf_align(e, softness, limits);
    if (soft) {
        rf_vote(e, softness);
        rf_settle(e, softness);
        rf_restore_thin(e, softness);
        for (int y = 0; y < e->height; y++)
            memcpy(e->map + y * e->stride, e->label + y * e->stride,
                   (size_t)e->width * sizeof *e->map);
    }
    report->softness = (float)(softness * pixel);
    report->on_photo = (float)found.on_photo;
    report->grown = (float)(found.grown * pixel);
    report->shift_x = (float)(found.shift_x * pixel);
    report->shift_y = (float)(found.shift_y * pixel);
    report->bent = found.bent;
    report->parted = soft;
    return soft || found.bent || found.grown || found.shift_x || found.shift_y;
}

/* The share of pixels that differ from what straight lines between the samples make. */
static float share_changed(struct job *job)
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

static void copy_samples(const struct refocus_disparity *map, uint16_t *out, ptrdiff_t stride)
{
    for (int y = 0; y < map->height; y++) {
        uint16_t *row = (uint16_t *)((char *)out + y * stride);

        for (int x = 0; x < map->width; x++)
            row[x] = sample_at(map, x, y);
    }
}

static int upsample(const struct refocus_image *photo, const struct refocus_disparity *map,
                    const struct refocus_depth_edges_params *params, uint16_t *out,
                    ptrdiff_t stride)
{
    struct refocus_upsample_params upsample = refocus_upsample_params_default();

    upsample.threads = params->threads;
    upsample.cpu = params->cpu;
    return refocus_upsample(photo, map, &upsample, out, stride);
}

/* Brings the result to the photo's size. */
static int give_out(const struct job *job, const struct refocus_depth_edges_params *params,
                    bool changed, uint16_t *out, ptrdiff_t stride)
{
    const struct rf_edges *e = &job->edges;
    const struct refocus_disparity result =
        refocus_disparity16(e->map, e->width, e->height, e->stride * (ptrdiff_t)sizeof *e->map);

    if (changed || job->enlarged)
        return upsample(job->photo, &result, params, out, stride);
    copy_samples(job->map, out, stride);
    return REFOCUS_OK;
}

/* The photo is reduced by a power of two until the map need not be enlarged by more than
 * MOST_ENLARGED. */
static void choose_size(struct job *job)
{
    const struct refocus_image *photo = job->photo;
    const struct refocus_disparity *map = job->map;
    struct rf_edges *e = &job->edges;

    job->reduced = 1;
    do {
        e->width = (photo->width + job->reduced - 1) / job->reduced;
        e->height = (photo->height + job->reduced - 1) / job->reduced;
        job->reduced *= 2;
    } while ((int64_t)map->width * MOST_ENLARGED < e->width &&
             (int64_t)map->height * MOST_ENLARGED < e->height);
    job->reduced /= 2;
    e->stride = rf_larger(e->width, RF_MOST_VOTE_COLUMNS) + 2;
    job->columns = rf_smaller(map->width, e->width);
    job->rows = rf_smaller(map->height, e->height);
    job->enlarged = job->columns != e->width || job->rows != e->height || job->reduced > 1 ||
                    map->width != photo->width || map->height != photo->height;
}

static int place(struct job *job, const struct refocus_depth_edges_params *params, uint16_t *out,
                 ptrdiff_t stride, struct refocus_depth_edges_report *report)
{
    struct rf_edges *e = &job->edges;
    bool changed;

    if (job->enlarged) {
        const double softness = softness_of_samples(job);

        if (softness < MIXED) {
            report->softness = (float)(softness * job->photo->width / job->columns);
            report->parted = 1;
            return upsample(job->photo, job->map, params, out, stride);
        }
    }
    rf_pool_run(e->pool, load_photo, job, e->height);
    load_map(job);
    changed = run(job, report);
    report->changed = changed ? share_changed(job) : 0;
    return give_out(job, params, changed, out, stride);
}

static int start(struct job *job, const struct refocus_depth_edges_params *params, uint16_t *out,
                 ptrdiff_t stride, struct refocus_depth_edges_report *report)
{
    struct rf_edges *e = &job->edges;
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct rf_run run_state = {.looked_at = NULL};
    struct rf_pool pool;
    void *block;
    int status;

    lay_out(e, &arena);
    if (arena.used > PTRDIFF_MAX)
        return REFOCUS_ERR_SIZE;
    block = malloc((size_t)arena.used);
    if (!block)
        return REFOCUS_ERR_MEMORY;
    arena.base = (uint8_t *)block + (-(uintptr_t)block & (RF_ARENA_ALIGN - 1));
    arena.used = 0;
    lay_out(e, &arena);
    job->sample = (struct rf_disparity_q16){e->near, e->stride};
    atomic_init(&run_state.state, RF_RUN_RUNNING);
    status = rf_pool_start(&pool, rf_thread_count(params->threads), NULL, &run_state);
    if (status == REFOCUS_OK) {
        e->pool = &pool;
        status = place(job, params, out, stride, report);
        rf_pool_end(&pool);
    }
    free(block);
    return status;
}

int refocus_depth_edges(const struct refocus_image *photo, const struct refocus_disparity *map,
                        const struct refocus_depth_edges_params *given, uint16_t *out,
                        ptrdiff_t stride, struct refocus_depth_edges_report *report)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_depth_edges_report, changed);
    struct refocus_depth_edges_report found = refocus_depth_edges_report_default();
    struct refocus_depth_edges_params params;
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    struct rf_kernels kernels;
    struct job job = {.photo = &own_photo, .map = &own_map, .edges = {.kernels = &kernels}};
    int status;

    if ((status = rf_read_image(NULL, "photo", &own_photo, photo)) ||
        (status = rf_read_map(NULL, "map", &own_map, map)) ||
        (status = refocus_struct_read(&params, sizeof params,
                                      REFOCUS_SIZE_TO(struct refocus_depth_edges_params, reserved),
                                      given)))
        return status;
    if (!refocus_format_bytes(own_photo.format) || params.threads < 0 ||
        params.threads > RF_MAX_THREADS || !refocus_cpu_name(params.cpu) || params.reserved ||
        !out || ((uintptr_t)out & 1) || (stride & 1) ||
        !rf_good_stride(stride, 2 * (ptrdiff_t)own_photo.width, own_photo.height) ||
        (report && (report->struct_size < first || report->struct_size > REFOCUS_MAX_STRUCT_SIZE)))
        return REFOCUS_ERR_ARGUMENT;
    if (!rf_kernels_select(&kernels, &params.cpu))
        return REFOCUS_ERR_UNSUPPORTED;
    choose_size(&job);
    status = start(&job, &params, out, stride, &found);
    if (status == REFOCUS_OK && report)
        refocus_struct_write(report, first, &found, sizeof found);
    return status;
}
