/* measure.c: measures the times of the kernels, on rows that look like a photo with two depths. */
#include <refocus/measure.h>

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "kernels/kernels.h"

enum { N = 1024, MARGIN = 256, ROW = N + 2 * MARGIN, SHORTS = 12, FLOATS = 6 };

/* Rows with a margin: what each kernel takes them for is its business. */
struct rows {
    uint16_t shorts[SHORTS][ROW];
    int16_t blur[3][ROW];
    uint32_t sums[ROW];
    uint64_t wide[2][RF_TILE * RF_TILE];
    float floats[FLOATS][ROW];
    uint16_t plane[4 * RF_TILE][4 * ROW]; /* blur and light of a strip, one after the other */
    uint8_t unsure[ROW];                  /* all 0 */
    uint32_t strip_sum[3][RF_STRIP_LANES];
    uint64_t strip_wide[4][RF_STRIP_LANES];
    struct rf_sorted_rays rays;
    struct rf_search_rays searched;
};

typedef void measured_fn(const struct rf_kernels *k, struct rows *r);

static void signed_blur(const struct rf_kernels *k, struct rows *r)
{
    k->signed_blur(r->blur[1], r->shorts[0] + MARGIN, (struct rf_focus){20000, 20 << 8, 0}, N);
}

static void smooth3(const struct rf_kernels *k, struct rows *r)
{
    uint16_t *const out[3] = {r->shorts[6], r->shorts[7], r->shorts[8]};
    const uint16_t *const light[3] = {r->shorts[0] + MARGIN, r->shorts[1] + MARGIN,
                                      r->shorts[2] + MARGIN};

    k->smooth3(out, light, r->blur[0] + MARGIN, 1, 3 << 8, 1, N);
}

static void spread_row(const struct rf_kernels *k, struct rows *r)
{
    k->spread_row(r->shorts[9] + MARGIN, r->shorts[10] + MARGIN, 40, 0, N);
}

static void dilate_from(const struct rf_kernels *k, struct rows *r)
{
    k->dilate_from(r->shorts[9] + MARGIN, r->shorts[0] + MARGIN, 0, N);
}

static void mark_foreground(const struct rf_kernels *k, struct rows *r)
{
    k->mark_foreground(r->blur[1] + MARGIN, r->blur[0] + MARGIN, r->shorts[0] + MARGIN, N);
}

static void push(const struct rf_kernels *k, struct rows *r)
{
    uint16_t *const out[3] = {r->shorts[6], r->shorts[7], r->shorts[8]};
    const uint16_t *const upper[3] = {r->shorts[0], r->shorts[1], r->shorts[2]};
    const uint16_t *const lower[3] = {r->shorts[3], r->shorts[4], r->shorts[5]};

    k->push(out, r->blur[1], upper, lower, r->blur[0], r->blur[2], 1280, N / 2);
}

static void pull(const struct rf_kernels *k, struct rows *r)
{
    const struct rf_parents parents = {r->shorts[0] + MARGIN, r->shorts[1] + MARGIN,
                                       r->blur[0] + MARGIN, r->blur[1] + MARGIN, 1280};

    k->pull(r->shorts[6] + MARGIN, r->blur[2] + MARGIN, &parents,
            (struct rf_mixed_parents){r->shorts[7], (int16_t *)r->shorts[8]}, N / 2);
}

static void means(const struct rf_kernels *k, struct rows *r)
{
    k->means(r->shorts[6], r->sums, rf_mean_scale(64), N);
}

static void weighted_means(const struct rf_kernels *k, struct rows *r)
{
    for (int i = 0; i < N; i += RF_TILE * RF_TILE)
        k->weighted_means(r->shorts[6], r->wide[0], r->wide[1], RF_TILE * RF_TILE);
}

static void blend4(const struct rf_kernels *k, struct rows *r)
{
    const uint16_t *const row[4] = {r->shorts[0], r->shorts[1], r->shorts[2], r->shorts[3]};

    k->blend4(r->shorts[6], row, (const int16_t[4]){4000, 12000, 12500, 4268}, N);
}

static void median3(const struct rf_kernels *k, struct rows *r)
{
    const uint16_t *const row[3] = {r->shorts[0] + MARGIN, r->shorts[1] + MARGIN,
                                    r->shorts[2] + MARGIN};
    const uint8_t *const sure[3] = {r->unsure + MARGIN, r->unsure + MARGIN, r->unsure + MARGIN};

    k->median3(r->shorts[6] + MARGIN, row, sure, N);
}

static void series_row(const struct rf_kernels *k, struct rows *r)
{
    const struct rf_series_job job = {.here = r->floats[1] + MARGIN,
                                      .start = r->floats[3],
                                      .across = r->floats[4],
                                      .own = r->floats[5],
                                      .stride = ROW,
                                      .share = 0.01f};

    memcpy(r->floats[0], r->floats[3], N * sizeof(float));
    k->series_row(r->floats[0], &job, N);
}

static void smooth_codes(const struct rf_kernels *k, struct rows *r)
{
    const uint16_t *const row[3] = {r->shorts[0] + MARGIN, r->shorts[1] + MARGIN,
                                    r->shorts[2] + MARGIN};

    k->smooth_codes(r->shorts[6], row, 1, 411, N);
}

/* A chunk of rays over a strip, each with one test that some pixels pass. */
static void sweep(const struct rf_kernels *k, struct rows *r)
{
    static const struct rf_slab slab = {-20 * 256, 256, -20 * 256};
    const ptrdiff_t stride = 4 * ROW, pitch = ROW;
    uint16_t *strip = r->plane[RF_TILE] + MARGIN;
    const struct rf_sweep_job job = {.blur = (const int16_t *)strip,
                                     .lanes = RF_STRIP_LANES,
                                     .steps = 16,
                                     .stride = stride,
                                     .pitch = pitch,
                                     .rays = &r->rays};
    uint32_t *const sum[3] = {r->strip_sum[0], r->strip_sum[1], r->strip_sum[2]};

    for (int n = 0; n < RF_RAY_CHUNK; n++) {
        r->rays.tests[n] = 1;
        r->rays.from[0][n] = rf_range_from(&slab);
        r->rays.to[0][n] = rf_range_to(&slab, &slab);
        r->rays.offset[0][n] = (int32_t)((n / 8 - 4) * stride + (n % 8 - 4) * 5);
        r->rays.last[n] = strip + pitch + n % 5;
    }
    r->rays.rays = RF_RAY_CHUNK;
    memset(r->strip_sum, 0, sizeof r->strip_sum);
    k->sweep(sum, &job);
}

/* A chunk of rays over the same strip, of two tests each; light counts as its weight. */
static struct rf_search_job search_job(struct rows *r)
{
    enum { STRIDE = 4 * ROW };
    uint16_t *const strip = r->plane[RF_TILE] + MARGIN;
    struct rf_search_rays *rays = &r->searched;

    rays->rays = RF_RAY_CHUNK;
    for (int n = 0; n < RF_RAY_CHUNK; n++) {
        rays->u[n] = (int16_t)((n % 8 - 4) * 3000);
        rays->v[n] = (int16_t)((n / 8 - 4) * 3000);
        rays->start[n] = (n / 8 - 4) * STRIDE + (n % 8 - 4) * 5;
        rays->within[n] = 128;
    }
    return (struct rf_search_job){.blur = (const int16_t *)strip,
                                  .light = {strip + ROW, strip + 2 * ROW, strip + 3 * ROW},
                                  .stride = STRIDE,
                                  .tests = 2,
                                  .steps = 16,
                                  .rays = rays,
                                  .weight = strip + ROW,
                                  .weight_stride = STRIDE};
}

static void search(const struct rf_kernels *k, struct rows *r)
{
    const struct rf_search_job job = search_job(r);

    memset(r->strip_sum, 0, sizeof r->strip_sum);
    k->search((uint32_t *const[3]){r->strip_sum[0], r->strip_sum[1], r->strip_sum[2]}, &job);
}

static void search_weighted(const struct rf_kernels *k, struct rows *r)
{
    const struct rf_search_job job = search_job(r);

    k->search_weighted((uint64_t *const[4]){r->strip_wide[0], r->strip_wide[1], r->strip_wide[2],
                                            r->strip_wide[3]},
                       &job);
}

static const struct {
    const char *name, *unit;
    measured_fn *run;
    double count; /* units that a run takes */
} measured[] = {
    {"sweep", "ray sample", sweep, RF_RAY_CHUNK *RF_STRIP_LANES},
    {"search", "ray sample", search, RF_RAY_CHUNK *RF_STRIP_LANES},
    {"search_weighted", "ray sample", search_weighted, RF_RAY_CHUNK *RF_STRIP_LANES},
    {"signed_blur", "pixel", signed_blur, N},
    {"smooth3", "pixel", smooth3, N},
    {"spread_row", "pixel", spread_row, N},
    {"dilate_from", "pixel", dilate_from, N},
    {"mark_foreground", "pixel", mark_foreground, N},
    {"push", "pixel", push, N / 2},
    {"pull", "pixel", pull, N},
    {"means", "pixel", means, N},
    {"weighted_means", "pixel", weighted_means, N},
    {"blend4", "pixel", blend4, N},
    {"median3", "pixel", median3, N},
    {"series_row", "pixel", series_row, N},
    {"smooth_codes", "pixel", smooth_codes, N},
};

static void fill(struct rows *r)
{
    uint32_t seed = 1;

    for (int x = 0; x < ROW; x++) {
        for (int i = 0; i < SHORTS; i++)
            r->shorts[i][x] = (uint16_t)((seed = seed * 1664525u + 1013904223u) >> 20);
        for (int i = 0; i < FLOATS; i++)
            r->floats[i][x] = 0.1f + (float)(r->shorts[i][x]) / 16384;
        r->blur[0][x] = (int16_t)((x / 50 % 2 ? -20 : 12) * 256 + r->shorts[0][x] % 64);
        r->blur[2][x] = (int16_t)(x / 50 % 2 ? RF_NO_BLUR : r->blur[0][x]);
        r->sums[x] = 64u * r->shorts[1][x];
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i++) {
        r->wide[1][i] = 1000u + r->shorts[2][i];
        r->wide[0][i] = r->wide[1][i] * r->shorts[3][i];
    }
    for (int y = 0; y < 4 * RF_TILE; y++) {
        memcpy(r->plane[y], r->blur[0], sizeof r->blur[0]);
        for (int c = 0; c < 3; c++)
            memcpy(r->plane[y] + (c + 1) * ROW, r->shorts[c], sizeof r->shorts[c]);
    }
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double best_ns(measured_fn *run, const struct rf_kernels *kernels, struct rows *rows)
{
    enum { AT_ONCE = 20 };
    const double end = seconds() + 0.02;
    double best = 1e9;

    do {
        const double start = seconds();
        double elapsed;

        for (int i = 0; i < AT_ONCE; i++)
            run(kernels, rows);
        elapsed = (seconds() - start) / AT_ONCE;
        best = elapsed < best ? elapsed : best;
    } while (seconds() < end);
    return best * 1e9;
}

enum { FIRST_TIME = REFOCUS_SIZE_TO(struct refocus_kernel_time, ns_c) };

int refocus_measure_kernel(uint32_t index, uint32_t cpu, struct refocus_kernel_time *time)
{
    struct refocus_kernel_time found = refocus_kernel_time_default();
    struct rf_kernels own, plain;
    uint32_t c = REFOCUS_CPU_C;
    struct rows *rows;

    if (index >= sizeof measured / sizeof *measured || !refocus_cpu_name(cpu) || !time ||
        time->struct_size < FIRST_TIME || time->struct_size > REFOCUS_MAX_STRUCT_SIZE)
        return REFOCUS_ERR_ARGUMENT;
    if (!rf_kernels_select(&own, &cpu) || !rf_kernels_select(&plain, &c))
        return REFOCUS_ERR_UNSUPPORTED;
    rows = calloc(1, sizeof *rows);
    if (!rows)
        return REFOCUS_ERR_MEMORY;
    fill(rows);
    found.name = measured[index].name;
    found.unit = measured[index].unit;
    found.ns = best_ns(measured[index].run, &own, rows) / measured[index].count;
    found.ns_c = best_ns(measured[index].run, &plain, rows) / measured[index].count;
    free(rows);
    return refocus_struct_write(time, FIRST_TIME, &found, sizeof found);
}
