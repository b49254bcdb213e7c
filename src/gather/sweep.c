/* sweep.c: the sweep: averages what the rays of a tile hit first, found slab by slab.
 *
 * Yang et al. 2016 ask for the front-most q on the ray of p with q = p + u s(q) (eq. 4),
 * relaxed to half a pixel. Over a tile, few signed blurs s can be hit at all. They are
 * covered, nearest first, by slabs one pixel wide. For one ray and one slab the offset
 * u s_slab is the same for the whole tile; each pixel that is still without a hit looks
 * there, and has one if the blur found lies in the slab. A pixel without any hit at the end
 * sees past every surface, into the hidden background.
 *
 * An example: a tile has blurs from 1.0 to 3.0, so its slabs are [1, 2] and [2, 3], with
 * centres 1.5 and 2.5. The ray (u, v) = (0.8, 0) looks 0.8 x 1.5 = 1.2, so 1 pixel to the right for
 * the first slab, and 0.8 x 2.5 = 2 pixels for the second, at every pixel of the tile. Where
 * the blur 1 pixel to the right is 1.7, the ray hits in the first slab: eq. 4 asks for 0.8 x 1.7
 * = 1.36 pixels, 0.36 from the pixel found, and so within half a pixel. Where it is 2.4,
 * the second slab is tested: a blur of 2.4 found 2 pixels away is a hit there, as eq. 4 asks for
 * 1.92. Where that blur is 1.2, the surface is too near to be hit there, and the ray sees the
 * hidden background.
 *
 * This is plain C that states the arithmetic; sums are whole numbers, so their order does
 * not matter.
 */
#include "gather/corners.h"
#include "gather/fine_means.h"
#include "gather/frame.h"
#include "gather/sums.h"
#include "gather/tile_rays.h"
#include "gather/tile_rows.h"
#include "image/viewport.h"
#include "thin/thin.h"

#include <assert.h>
#include <stdalign.h>
#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* A tile, what its rays may hit, and what is computed of it. */
struct tile {
    const struct rf_frame *f;
    int tx, ty;
    struct rf_tile_plan plan;
    struct rf_tile_rays rays;
    int background_blur;        /* It is that of a corner of the tile, as it is stored. */
    int from, to;               /* channels `from` to `to` - 1 */
    struct rf_fine_means *fine; /* finer means of it, or NULL */
    struct share *share;
};

/* Where at most RF_RAY_CHUNK rays look for the slabs of a tile and, last, for the hidden
 * background. */
struct lookups {
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t cell[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t weight_offset[RF_MAX_SLABS][RF_RAY_CHUNK];
    int rays; /* last, so that rows begin with cache lines */
};

/* Rays of one side of the focus, u and v apart: they are those of the set, or were made for the
 * tile. */
struct aims {
    const int16_t *u, *v;
    int16_t memory[2][RF_RAY_CHUNK];
};

static void set_aims(struct aims *aims, const struct rf_ray_set *set, int first,
                     const struct refocus_ray *ray, int rays)
{
    if (ray == set->ray + first && set->u) {
        aims->u = set->u + first;
        aims->v = set->v + first;
        return;
    }
    for (int n = 0; n < rays; n++) {
        aims->memory[0][n] = ray[n].u;
        aims->memory[1][n] = ray[n].v;
    }
    aims->u = aims->memory[0];
    aims->v = aims->memory[1];
}

static void set_lookups(struct lookups *lookups, const struct tile *tile, int first)
{
    const struct rf_frame *const f = tile->f;
    const struct rf_tile_plan *const plan = &tile->plan;
    const struct rf_tile_rays *const rays = &tile->rays;
    struct rf_ray_sides sides;
    struct aims own[2];

    rf_tile_rays_get(rays, first, lookups->rays, &sides);
    set_aims(&own[0], rays->set, first, sides.behind, lookups->rays);
    if (sides.before != sides.behind)
        set_aims(&own[1], rays->set, first, sides.before, lookups->rays);
    for (int k = 0; k <= plan->slabs; k++) {
        const int blur = k < plan->slabs ? plan->slab[k].centre : tile->background_blur;
        const int scaled = rf_scaled_blur(rays, blur);
        const struct aims *aims = &own[blur < 0 && sides.before != sides.behind];

        if (f->weighted && k < plan->slabs)
            f->exec->kernels->aim(lookups->weight_offset[k], lookups->cell[k], aims->u, aims->v,
                                  scaled, f->blur.unit, (int32_t)f->weight.stride,
                                  (int32_t)f->range.stride, lookups->rays);
        f->exec->kernels->aim(lookups->offset[k], lookups->cell[k], aims->u, aims->v, scaled,
                              f->blur.unit, (int32_t)f->view->stride, (int32_t)f->range.stride,
                              lookups->rays);
    }
}

/* The sums of a tile: of light, or of light times weight and of weights. */
union tally {
    uint32_t sum[3][LANES];
    uint64_t weighted[4][LANES];
};

/* The share of a worker, for a tile until its means are computed. Vectors of sums that cross cache
 * lines cost a twentieth of a frame. */
struct share {
    alignas(64) union tally run; /* rays of equal weight */
    alignas(64) struct rf_sums sums;
    alignas(64) struct lookups lookups;
    alignas(64) struct rf_sorted_rays sorted;
    alignas(64) uint32_t corners[3][LANES];
    bool past_slabs; /* Some ray of the tile looks past all slabs. */
};

/* Where fine means lie in the share: splats, which come between, use what is before them. */
static uint64_t fine_at(void)
{
    return sizeof(struct share) > rf_splat_share() ? sizeof(struct share) : rf_splat_share();
}

uint64_t rf_sweep_share(void)
{
    return fine_at() + sizeof(struct rf_fine_means);
}

/* Rows of a tile that are computed together. */
struct strip {
    int y, step, rows; /* y in the tile */
    int first;         /* lane of the tally */
};

static void sweep_strip(const struct tile *tile, struct strip strip)
{
    enum { CELLS = RF_TILE / RF_CELL, STRIP_CELLS = RF_STRIP / RF_CELL };
    const struct rf_frame *const f = tile->f;
    const struct rf_tile_plan *const plan = &tile->plan;
    struct share *const share = tile->share;
    const struct lookups *lookups = &share->lookups;
    union tally *const run = &share->run;
    const int first = strip.first, y = tile->ty * RF_TILE + strip.y, x = tile->tx * RF_TILE;
    const ptrdiff_t at = y * f->view->stride + x, weight_at = y * f->weight.stride + x;
    const uint32_t *range =
        f->range.at + (tile->ty * CELLS + strip.y / RF_CELL) * f->range.stride + tile->tx * CELLS;
    /* The vectors of sweep_weighted hold 8 times white at the most. */
    rf_sweep_weighted_fn *const weighted =
        f->bright == RF_BRIGHTEST ? rf_sweep_weighted_c : f->exec->kernels->sweep_weighted;
    const struct rf_sort_job sort = {
        .range = range,
        .below = strip.step > 2 ? range + STRIP_CELLS * f->range.stride : NULL,
        .front = f->smooth.channel[0] + at,
        .background = f->background.light.channel[0] + at,
        .weight = f->weighted ? f->weight.at + weight_at : NULL,
        .background_weight = f->weighted ? f->background_weight.at + at : NULL,
        .rays = lookups->rays,
        .slabs = plan->slabs,
        .skip_deepest = rf_skips_deepest_test(f),
        .slab = plan->slab,
        .joined = plan->joined,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->offset,
        .cell = (const int32_t(*)[RF_RAY_CHUNK])lookups->cell,
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->weight_offset,
    };
    const struct rf_sweep_job job = {
        .blur = f->blur.at + at,
        .stride = strip.step * f->view->stride,
        .pitch = f->light.channel[1] - f->light.channel[0],
        .rays = &share->sorted,
        .steps = rf_steps_of(plan),
        .bright = f->bright,
        .lanes = strip.rows * RF_TILE,
        .weight = sort.weight,
        .weight_stride = strip.step * f->weight.stride,
    };

    f->exec->kernels->sort_rays(&share->sorted, &sort);
    share->past_slabs = share->past_slabs || share->sorted.past_slabs;
    if (f->weighted)
        weighted((uint64_t *const[4]){run->weighted[0] + first, run->weighted[1] + first,
                                      run->weighted[2] + first, run->weighted[3] + first},
                 &job);
    else
        f->exec->kernels->sweep(
            (uint32_t *const[3]){run->sum[0] + first, run->sum[1] + first, run->sum[2] + first},
            &job);
}

/* Sweeps the rows of a tile that are computed. */
static void sweep_strips(const struct tile *tile, struct rf_tile_rows rows)
{
    const int count = rows.step <= 2 ? rows.count / 2 : rows.count;

    for (int i = 0; i < rows.count; i += count)
        sweep_strip(tile, (struct strip){rf_row_at(rows, i), rows.step, count, i * RF_TILE});
}

static void clear_run(const struct rf_frame *f, union tally *run, int lanes)
{
    for (int c = 0; c < (f->weighted ? 4 : 3); c++)
        if (f->weighted)
            memset(run->weighted[c], 0, (size_t)lanes * sizeof run->weighted[c][0]);
        else
            memset(run->sum[c], 0, (size_t)lanes * sizeof run->sum[c][0]);
}

/* Adds a run of rays of equal weight, which is at its end, as often as its rays weigh. */
static void add_run(const struct rf_frame *f, const union tally *run, uint64_t ray_weight,
                    uint64_t rays, struct rf_sums *sums)
{
    for (int i = 0; i < LANES; i++) {
        for (int c = 0; c < 3; c++)
            sums->light[c][i] += ray_weight * (f->weighted ? run->weighted[c][i] : run->sum[c][i]);
        sums->weight[i] += ray_weight * (f->weighted ? run->weighted[3][i] : rays);
    }
}

/* Rays come in runs of equal weight; a run is summed plainly and counts as often as it weighs. The
 * sum of a set of equal rays is left in share->run; others are added up in share->sums. */
static_assert((uint64_t)RF_FULL_RAYS * RF_MOST_GAIN * RF_LIGHT_MAX <= UINT32_MAX,
              "a run of all rays of the brightest light fits 32 bits");
static_assert((uint64_t)RF_FULL_RAYS * RF_MOST_GAIN * RF_LIGHT_MAX * RF_WEIGHT_MAX < UINT64_C(1)
                                                                                         << 51,
              "and of weighted light what kernels->weighted_means takes");
static void sweep_rays(const struct tile *tile, struct rf_tile_rows rows)
{
    const struct rf_frame *const f = tile->f;
    const struct rf_ray_set *set = tile->rays.set;
    struct share *const share = tile->share;
    struct lookups *const lookups = &share->lookups;
    const int lanes = rows.count * RF_TILE;
    int rays = 0; /* in this run */

    clear_run(f, &share->run, lanes);
    for (int n = 0; n < set->count; n += lookups->rays) {
        const struct refocus_ray *ray = &set->ray[n];

        if (rf_cancelled(f->exec))
            return;
        lookups->rays = rf_rays_of_equal_weight(set, n);
        rays += lookups->rays;
        set_lookups(lookups, tile, n);
        sweep_strips(tile, rows);
        if (!set->equal &&
            (n + lookups->rays == set->count || ray[lookups->rays].weight != ray->weight)) {
            add_run(f, &share->run, ray->weight, (uint64_t)rays, &share->sums);
            clear_run(f, &share->run, lanes);
            rays = 0;
        }
    }
}

/* Clamps the sums of rays of equal weight to those of the largest mean. */
static void clamp_run(union tally *run, int lanes, bool wide, uint32_t rays)
{
    for (int c = 0; c < 3; c++) {
        if (!wide)
            rf_clamp_sums(run->sum[c], rays, lanes);
        for (int i = 0; wide && i < lanes; i++) {
            const uint64_t most = RF_MOST_MEAN * run->weighted[3][i];

            run->weighted[c][i] = run->weighted[c][i] < most ? run->weighted[c][i] : most;
        }
    }
}

/* Computes the means of a tile from rays of equal weight. */
static void sweep_means(const struct tile *tile, uint16_t mean[3][LANES])
{
    const struct rf_frame *const f = tile->f;
    const uint32_t count = (uint32_t)tile->rays.set->count;
    const struct rf_tile_rows rows = rf_tile_rows(f, &tile->plan, tile->background_blur);
    const uint16_t softness = rf_softness(f, &tile->plan, tile->background_blur);
    const int lanes = rows.count * RF_TILE;
    uint16_t computed[LANES];
    union tally *const run = &tile->share->run;

    sweep_rays(tile, rows);
    if (rf_cancelled(f->exec))
        return;
    if (rf_exceeds_means(&tile->plan))
        clamp_run(run, lanes, f->weighted, count);
    for (int c = tile->from; c < tile->to; c++) {
        uint16_t *out = rows.step > 1 ? computed : mean[c];

        if (f->weighted)
            f->exec->kernels->weighted_means(out, run->weighted[c], run->weighted[3], lanes);
        else
            f->exec->kernels->means(out, run->sum[c], rf_mean_scale(count), lanes);
        if (softness)
            f->exec->kernels->soften(out, rows.count, 1, rows.step == 1, softness);
        if (rows.step > 1)
            f->exec->kernels->between_rows(mean[c], computed, rows.step);
        if (tile->fine)
            rf_fine_means(tile->fine, c, f->exec->kernels,
                          &(struct rf_mean_steps){rows, softness, count}, run->sum[c], mean[c]);
    }
}

/* Computes these means from rays that do not weigh the same. */
static void sweep_sums(const struct tile *tile, uint16_t mean[3][LANES])
{
    const struct rf_frame *const f = tile->f;
    const uint64_t most = 4 * RF_MOST_MEAN;
    const uint16_t softness = rf_softness(f, &tile->plan, tile->background_blur);
    struct rf_sums *const sums = &tile->share->sums;

    memset(sums, 0, sizeof *sums);
    sweep_rays(tile, (struct rf_tile_rows){1, RF_TILE});
    if (rf_cancelled(f->exec)) /* a cancelled run has no weights to divide by */
        return;
    for (int c = tile->from; c < tile->to; c++) {
        for (int i = 0; i < LANES; i++) {
            const uint64_t w = sums->weight[i], v = (4 * sums->light[c][i] + w / 2) / w;

            mean[c][i] = (uint16_t)(v < most ? v : most);
        }
        if (softness)
            f->exec->kernels->soften(mean[c], RF_TILE, 1, true, softness);
    }
}

/* Computes means for the blur of the hidden background at each corner of the tile. */
static void sweep_corners(struct tile *tile, const struct rf_corners *corners,
                          uint16_t mean[3][LANES])
{
    static const struct rf_corner_layout pixels = {1, 1};
    struct share *const share = tile->share;

    share->past_slabs = false;
    for (int k = 0; k < corners->count && !rf_cancelled(tile->f->exec); k++) {
        const bool repeats = rf_corner_repeats(corners, k, tile->f, &tile->plan, share->past_slabs);

        tile->background_blur = corners->blur[k];
        if (!repeats && tile->rays.set->equal)
            sweep_means(tile, mean);
        else if (!repeats)
            sweep_sums(tile, mean);
        for (int c = tile->from; c < tile->to && corners->count > 1; c++)
            rf_add_corner(share->corners[c], mean[c], corners, k, pixels);
    }
    for (int c = tile->from; c < tile->to && corners->count > 1; c++)
        rf_corner_means(mean[c], share->corners[c], pixels);
}

void rf_sweep_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct tile tile;
    struct rf_corners corners;
    uint16_t mean[3][LANES];
    void *const share = rf_share(&f->exec->shares, worker);

    tile.f = f;
    tile.tx = tx;
    tile.ty = ty;
    tile.share = share;
    tile.fine = NULL;
    rf_plan_tile(f->view, f->bins, &f->reach, tx, ty, &tile.plan);
    if (tile.plan.sharp && f->thin.disc_scale && rf_has_coverage(&f->thin, tx, ty)) {
        rf_thin_sharp_means(&f->thin, tx, ty, mean);
        rf_coverage_over(&f->thin, tx, ty, mean);
        rf_encode_means(f, rect, mean);
        return;
    }
    if (tile.plan.sharp) {
        rf_copy_tile(f, rect);
        return;
    }
    rf_expect_tile(f, rect);
    rf_tile_rays_make(&tile.rays, f,
                      rf_choose_ray_set(f->ray_sets, tile.plan.reach, tile.plan.undersampled), tx,
                      ty);
    rf_find_corners(&corners, f, tx, ty);
    if (f->deep_out->on && tile.rays.set->equal && !f->weighted && corners.count == 1)
        tile.fine = (void *)((uint8_t *)share + fine_at());
    for (int pass = 0; pass < (f->params->fringe != 0 ? 2 : 1); pass++) {
        tile.from = pass; /* all channels, and green again */
        tile.to = pass ? 2 : 3;
        if (pass)
            rf_use_green_rays(&tile.rays, f->params->fringe);
        sweep_corners(&tile, &corners, mean);
    }
    if (f->splats)
        rf_splat_highlights(&f->splat, &tile.plan, tx, ty, share,
                            (uint16_t *const[3]){mean[0], mean[1], mean[2]});
    if (f->thin.mattes)
        rf_matte_over(&f->thin, tx, ty, mean);
    if (f->thin.disc_scale)
        rf_coverage_over(&f->thin, tx, ty, mean);
    if (f->splats && tile.plan.highlight && !f->deep_out->on)
        f->exec->kernels->clamp_row(mean[0], RF_MEAN_MAX, 3 * LANES);
    if (rf_cancelled(f->exec))
        return;
    if (tile.fine)
        rf_encode_fine(f, rect, mean, tile.fine);
    else
        rf_encode_means(f, rect, mean);
}
