/* place.c: memory for the edges of a disparity map, and the order of the passes over them. */
#include "edges/place.h"

#include <math.h>
#include <string.h>

#include "depth/mixed_pixels.h"
#include "depth/upsample.h"
#include "edges/input.h"
#include "support/compare.h"

enum {
    MOST_ENLARGED = 4,     /* the map is brought to at most so many times its size */
    LEAST_CONTRAST = 2621, /* 0.04, of a ramp */
};
/* Softer edges hold disparities that nothing in the scene has. An exact map has 0.41. What lossy
 * compression leaves around the edges of an exact map looks soft, but many of them are steps still,
 * so that it is those that tell. */
static const double SOFT = 0.475;
enum { SHARP_PERCENTILE = 40 };
/* So do antialiased silhouettes, of which many pixels look like steps: 0.11 to 0.39 are mixed where
 * pixels are means over areas of two or three samples of six scenes, up to 0.04 where they are
 * samples, compressed or not. Between these is their geometric mean; with one scene left out it is
 * 0.045 to 0.09, and the one is on its side of that. Such means are no softer than SOFT. */
static const double ANTIALIASED = 0.065;
/* Samples of a small map that were taken at points, as sensors do, have 0.41 at their own size;
 * means over areas mix two surfaces along some edges. */
static const double MIXED = 0.5;

/* ----- sizes and memory ----- */

/* The photo is reduced by a power of two until one side of the map need not be enlarged by more
 * than MOST_ENLARGED. */
static void choose_size(struct rf_edge_job *job, int width, int height, int columns, int rows)
{
    struct rf_edges *e = &job->edges;

    job->reduced = 1;
    do {
        e->width = (width + job->reduced - 1) / job->reduced;
        e->height = (height + job->reduced - 1) / job->reduced;
        job->reduced *= 2;
    } while ((int64_t)columns * MOST_ENLARGED < e->width &&
             (int64_t)rows * MOST_ENLARGED < e->height);
    job->reduced /= 2;
    e->stride = rf_larger(e->width, RF_MOST_VOTE_COLUMNS) + 2;
    job->columns = rf_smaller(columns, e->width);
    job->rows = rf_smaller(rows, e->height);
    job->enlarged = columns != width || rows != height;
}

static void *take_plane(struct rf_arena *arena, const struct rf_edges *e, uint64_t size)
{
    return rf_arena_take(arena, (uint64_t)e->stride * ((uint64_t)e->height + 2), size);
}

/* Sets the pointers, or with arena->base == NULL only counts. Each plane has a border of a pixel.
 * The map comes first: the others are not needed to bring it to the photo's size. */
static void lay_out(struct rf_edge_job *job, struct rf_arena *arena)
{
    struct rf_edges *e = &job->edges;
    const uint64_t across = (uint64_t)rf_edge_blocks_across(e);
    const uint64_t blocks = across * (uint64_t)((e->height + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK);
    uint16_t **const planes[] = {&e->map,     &e->near,  &e->far, &e->label,
                                 &e->largest, &e->spare, &e->kept};
    struct rf_arena shared;
    int16_t **const slopes[] = {&e->gradient.x, &e->gradient.y};

    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        *planes[i] = take_plane(arena, e, sizeof **planes[i]);
        if (arena->base)
            *planes[i] += e->stride + 1;
    }
    for (size_t i = 0; i < sizeof slopes / sizeof *slopes; i++)
        *slopes[i] = take_plane(arena, e, sizeof **slopes[i]);
    for (int c = 0; c < 3; c++)
        e->colour[c] = take_plane(arena, e, 1);
    e->steepest = e->is_wide = take_plane(arena, e, 1);
    e->range = rf_arena_take(arena, blocks, sizeof *e->range);
    e->rough = rf_arena_take(arena, blocks, 1);
    e->rough_cell = rf_arena_take(arena, blocks, 1);
    for (int i = 0; i < 2; i++)
        e->moved[i] = rf_arena_take(arena, blocks, 1);
    e->most_edges = (int)((int64_t)e->width * e->height / 8);
    job->column = rf_arena_take(arena, (uint64_t)e->width, sizeof *job->column);
    shared = *arena;
    e->length = take_plane(&shared, e, sizeof *e->length);
    if (arena->base)
        e->length += e->stride + 1;
    e->edge = rf_arena_take(arena, (uint64_t)e->most_edges, sizeof *e->edge);
    rf_align_lay_out(e, arena);
    if (arena->used < shared.used)
        arena->used = shared.used;
}

/* A map that is brought to the photo's size, in memory that begins with it if it is the result of
 * the passes. */
static struct rf_arena behind_map(const struct rf_edges *e, uint8_t *memory)
{
    struct rf_arena arena = {memory, 0};

    take_plane(&arena, e, sizeof *e->map);
    return arena;
}

uint64_t rf_place_edges_bytes(int width, int height, int columns, int rows)
{
    const struct refocus_image photo = {.width = width, .height = height};
    struct rf_edge_job job;
    struct rf_arena arena = {NULL, 0}, last;
    struct rf_upsampler up = {.photo = &photo};

    choose_size(&job, width, height, columns, rows);
    last = behind_map(&job.edges, NULL);
    lay_out(&job, &arena);
    if (!job.enlarged)
        return arena.used;
    /* The map that comes in may have more samples than the one that the passes make of it. */
    up.columns = rf_larger(job.edges.width, rf_upsample_samples(columns, width));
    up.rows = rf_larger(job.edges.height, rf_upsample_samples(rows, height));
    rf_upsampler_lay_out(&up, &last);
    return arena.used > last.used ? arena.used : last.used;
}

/* The last step at the photo's size. Works in planes of that size. */
static void claim_mixed_pixels(const struct rf_place_edges *place, struct rf_disparity_q16 nearer,
                               struct rf_bytes run)
{
    const struct rf_mixed_pixels mixed = {place->photo, place->out, nearer, run, !place->last};

    if (!rf_run_cancelled(place->pool->run))
        rf_claim_mixed_pixels(&mixed, place->pool);
}

static void upsample(const struct rf_place_edges *place, const struct rf_edges *e,
                     const struct refocus_disparity *map)
{
    struct rf_arena arena = behind_map(e, place->memory);
    struct rf_upsampler up = {
        .kernels = place->kernels,
        .photo = place->photo,
        .map = map,
        .columns = rf_upsample_samples(map->width, place->photo->width),
        .rows = rf_upsample_samples(map->height, place->photo->height),
        .shares = place->shares,
        .out = place->out,
    };

    rf_upsampler_lay_out(&up, &arena);
    rf_upsample(&up, place->pool);
    claim_mixed_pixels(place, up.settled, up.sure);
}

/* ----- order of the passes ----- */

/* In a video softness follows slowly what is measured, unless it is another map. */
static double steady(const struct rf_edges *e, double softness)
{
    const double last = e->last ? e->last->softness : 0;

    return last > 0 && fabs(softness - last) < last / 4 ? (3 * last + softness) / 4 : softness;
}

/* Whether what was found of a map is enough to part it; in a video that leans to what the last
 * frame was. */
static bool is_enough(const struct rf_edges *e, double found, double least)
{
    return found >= least + (!e->last ? 0 : e->last->parted ? -0.03 : 0.03);
}

static bool is_moved(const struct refocus_depth_edges_report *found)
{
    return found->bent || found->grown != 0 || found->shift_x != 0 || found->shift_y != 0;
}

/* Works on job->edges and leaves the result in its map; says whether it differs from the samples.
 */
static bool run_passes(struct rf_edge_job *job, struct refocus_depth_edges_report *report)
{
    struct rf_edges *e = &job->edges;
    const double pixel = job->reduced;
    struct rf_ramp_limits limits;
    struct rf_alignment found;
    double softness;
    bool soft;

    rf_find_steepest(e);
    softness = steady(e, rf_measure_softness(e, RF_SOFTNESS_PERCENTILE));
    soft = job->enlarged || is_enough(e, rf_measure_softness(e, SHARP_PERCENTILE), SOFT);
    if (job->enlarged)
        softness = fmax(softness, SOFT);
    report->softness = (float)(softness * pixel);
    if (!soft && is_enough(e, rf_share_mixed(e), ANTIALIASED)) {
        soft = true;
        softness = fmin(softness, SOFT);
    }
    /* A ramp of a Gaussian is 4 standard deviations long. */
    limits =
        (struct rf_ramp_limits){.steps = (int)(4 * softness + 2.5), .contrast = LEAST_CONTRAST};
    if (soft)
        rf_find_ramps(e, limits);
    found = rf_align(e, softness, soft ? &limits : NULL);
    report->on_photo = (float)found.on_photo;
    report->grown = (float)(found.grown * pixel);
    report->shift_x = (float)(found.shift_x * pixel);
    report->shift_y = (float)(found.shift_y * pixel);
    report->bent = found.bent;
    report->parted = soft;
    report->specks = (float)job->impulses / 65536;
    report->noise = fminf((float)job->noise / 65535, 1);
    if (soft && (!job->points || is_moved(report)) && !rf_run_cancelled(e->pool->run)) {
        rf_vote(e, softness);
        rf_settle(e, softness);
        rf_restore_thin(e, softness);
        rf_copy_plane(e, e->map, e->label);
    }
    return soft || job->noise || job->impulses || is_moved(report);
}

static bool fits(const struct rf_last_edges *last, const struct rf_edges *e)
{
    return last && last->width == e->width && last->height == e->height;
}

/* Keeps the result for the next frame, and holds it where nothing changes. */
static void keep(struct rf_edges *e, struct rf_last_edges *last, const struct rf_edge_job *job,
                 const struct refocus_depth_edges_report *found)
{
    rf_hold_still(e, last);
    last->softness = (double)found->softness / job->reduced;
    last->parted = found->parted;
    last->aligned = is_moved(found);
}

/* Brings the result to the photo's size. */
static void give_out(const struct rf_place_edges *place, const struct rf_edges *e)
{
    const struct refocus_disparity result =
        refocus_disparity16(e->map, e->width, e->height, e->stride * (ptrdiff_t)sizeof *e->map);

    if (e->width != place->photo->width || e->height != place->photo->height) {
        upsample(place, e, &result);
        return;
    }
    for (int y = 0; y < e->height; y++)
        memcpy(place->out.at + y * place->out.stride, e->map + y * e->stride,
               (size_t)e->width * sizeof *e->map);
    claim_mixed_pixels(place, (struct rf_disparity_q16){e->near, e->stride},
                       (struct rf_bytes){e->is_wide, e->stride});
}

/* Samples that were taken at points are brought to the photo's size by depth/upsample.h, which
 * keeps their edges better, unless the map lies beside the photo; in a video always, as looking for
 * that takes time. */
bool rf_place_edges(const struct rf_place_edges *place, struct refocus_depth_edges_report *report)
{
    const struct refocus_image *photo = place->photo;
    const struct refocus_disparity *map = place->map;
    struct rf_arena arena = {place->memory, 0};
    struct rf_edge_job job = {.photo = photo, .map = map};
    struct rf_edges *e = &job.edges;
    double softness;
    bool changed;

    choose_size(&job, photo->width, photo->height, map->width, map->height);
    lay_out(&job, &arena);
    e->kernels = place->kernels;
    e->pool = place->pool;
    e->last = fits(place->last, e) ? place->last : NULL;
    job.sample = (struct rf_disparity_q16){e->near, e->stride};
    softness = job.enlarged ? rf_softness_of_samples(&job) : 0;
    job.points = job.enlarged && softness < MIXED;
    if (job.points && place->last) {
        place->last->width = 0;
        report->softness = (float)(softness * photo->width / job.columns);
        report->parted = 1;
        upsample(place, e, map);
        return true;
    }
    rf_load_edge_photo(&job);
    rf_load_edge_map(&job);
    if (place->last)
        rf_forget_moved(e, place->last);
    changed = run_passes(&job, report);
    if (rf_run_cancelled(place->pool->run))
        return false;
    if (job.points && !is_moved(report)) {
        upsample(place, e, map);
        return true;
    }
    if (place->last)
        keep(e, place->last, &job, report);
    report->changed = changed ? rf_share_changed(&job) : 0;
    if (changed || job.enlarged)
        give_out(place, e);
    return changed || job.enlarged;
}
