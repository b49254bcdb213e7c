/* sweep_yuv.c: the sweep for a photo of Y, U and V.
 *
 * What sweep.c does for three planes is done here for luma and, with the same slabs,
 * for chroma, whose samples lie two pixels apart: rays are half as long there across,
 * and in 4:2:0 down, and a part of them lies as densely among its samples as all rays do
 * among pixels.
 */
#include "gather/corners.h"
#include "gather/frame.h"
#include "gather/sums.h"
#include "gather/tile_rows.h"
#include "thin/thin.h"

#include <stdalign.h>
#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Luma or chroma, from a tile's first element on. */
struct plane {
    const int16_t *blur;
    const uint16_t *light, *background;
    int rows, steps;
    struct rf_tile_rows computed;
    int down; /* rows of pixels to one of the plane: 1 << down */
};

/* A tile, and the planes that its rays look into. */
struct tile {
    const struct rf_frame *f;
    struct rf_tile_plan plan;
    const struct rf_ray_set *set;
    int background_blur;   /* It is that of a corner of the tile, as it is stored. */
    const uint32_t *range; /* from the tile's first cell on */
    const uint16_t *weight, *background_weight; /* eq. 5 from its first pixel on, or NULL */
    struct plane luma, chroma;
};

/* At most RF_RAY_CHUNK rays of one weight, where they look for the slabs of the tile and for the
 * hidden background, and which of these lookups need a test. */
struct lookups {
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t cell[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    /* The lookups in chroma of the first rays, which it shares: */
    int32_t chroma_offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t chroma_pixel[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int16_t own_u[RF_RAY_CHUNK], own_v[RF_RAY_CHUNK];
    const int16_t *u, *v;
    int rays;
    struct rf_sorted_rays sorted;
};

static void set_rays(struct lookups *lookups, const struct rf_ray_set *set, int first)
{
    lookups->rays = rf_rays_of_equal_weight(set, first);
    lookups->u = set->u ? set->u + first : lookups->own_u;
    lookups->v = set->u ? set->v + first : lookups->own_v;
    for (int n = 0; !set->u && n < lookups->rays; n++) {
        lookups->own_u[n] = set->ray[first + n].u;
        lookups->own_v[n] = set->ray[first + n].v;
    }
}

/* The sums of luma [0] and of chroma [1]. A run of rays of one weight sums light, or light times
 * weights of eq. 5 and these weights; `sum` and `weight` add up all runs. */
struct sums {
    uint32_t run[2][LANES];
    uint64_t weighted_run[2][LANES], weight_run[2][LANES];
    uint64_t sum[2][LANES], weight[2][LANES];
};

/* The share of a worker, for a tile until its means are computed. */
struct share {
    alignas(64) struct sums sums;
    alignas(64) struct lookups lookups;
    alignas(64) uint32_t corners[2][LANES]; /* luma, chroma */
    bool past_slabs;                        /* Some ray of the tile looks past all slabs. */
};

uint64_t rf_sweep_yuv_share(void)
{
    return sizeof(struct share);
}

static void sweep_plane(const struct tile *tile, bool chroma, const struct rf_sorted_rays *rays,
                        struct sums *sums)
{
    const struct plane *plane = chroma ? &tile->chroma : &tile->luma;
    const struct rf_sweep1_job job = {
        .blur = plane->blur,
        .light = plane->light,
        .apart = rf_row_at(plane->computed, 1) * tile->f->view->stride,
        .half = rf_row_at(plane->computed, plane->computed.count / 2) * tile->f->view->stride,
        .rows = plane->computed.count,
        .steps = plane->steps,
        .chroma = chroma,
        .rays = rays,
        .weight = tile->weight,
        .down = plane->down,
    };

    if (tile->weight)
        tile->f->exec->kernels->sweep1_weighted(sums->weighted_run[chroma],
                                                sums->weight_run[chroma], &job);
    else
        tile->f->exec->kernels->sweep1(sums->run[chroma], &job);
}

/* Sorts rays, of which chroma shares the first `shared`. All strips of a tile are sorted together:
 * for one plane, sorting each by itself costs more than it saves. */
static void sort_rays(const struct tile *tile, struct lookups *lookups, int shared)
{
    const struct rf_sort_job job = {
        .range = tile->range,
        .front = tile->luma.light,
        .background = tile->luma.background,
        .rays = lookups->rays,
        .slabs = tile->plan.slabs,
        .skip_deepest = rf_skips_deepest_test(tile->f),
        .slab = tile->plan.slab,
        .joined = tile->plan.joined,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->offset,
        .cell = (const int32_t(*)[RF_RAY_CHUNK])lookups->cell,
        .weight = tile->weight,
        .background_weight = tile->background_weight,
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->offset,
        .shared = shared,
        .chroma_offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->chroma_offset,
        .chroma_weight_offset = (const int32_t(*)[RF_RAY_CHUNK])lookups->chroma_pixel,
        .chroma_front = tile->chroma.light,
        .chroma_background = tile->chroma.background,
    };

    for (int k = 0; k <= tile->plan.slabs; k++) {
        const int blur = k < tile->plan.slabs ? tile->plan.slab[k].centre : tile->background_blur;

        tile->f->exec->kernels->aim(lookups->offset[k], lookups->cell[k], lookups->u, lookups->v,
                                    blur, tile->f->blur.unit, (int32_t)tile->f->view->stride,
                                    (int32_t)tile->f->range.stride, lookups->rays);
        tile->f->exec->kernels->aim_chroma(
            lookups->chroma_offset[k], lookups->chroma_pixel[k], lookups->u, lookups->v, blur,
            tile->f->blur.unit, tile->chroma.down, (int32_t)tile->f->view->stride, shared);
    }
    tile->f->exec->kernels->sort_rays(&lookups->sorted, &job);
}

static void clear_run(const struct tile *tile, struct sums *sums)
{
    const struct plane *const plane[2] = {&tile->luma, &tile->chroma};

    for (int p = 0; p < 2; p++) {
        const size_t lanes = (size_t)plane[p]->computed.count * RF_TILE;

        if (tile->weight) {
            memset(sums->weighted_run[p], 0, lanes * sizeof sums->weighted_run[p][0]);
            memset(sums->weight_run[p], 0, lanes * sizeof sums->weight_run[p][0]);
        } else {
            memset(sums->run[p], 0, lanes * sizeof sums->run[p][0]);
        }
    }
}

/* Adds a run of rays of one weight, `rays[p]` of them in plane p. */
static void add_run(const struct tile *tile, struct sums *sums, uint64_t weight, const int rays[2])
{
    const int lanes[2] = {LANES, tile->chroma.rows * RF_TILE};

    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < lanes[p]; i++) {
            sums->sum[p][i] += weight * (tile->weight ? sums->weighted_run[p][i] : sums->run[p][i]);
            sums->weight[p][i] +=
                weight * (tile->weight ? sums->weight_run[p][i] : (uint64_t)rays[p]);
        }
    }
    clear_run(tile, sums);
}

/* Sums the rays run by run, as sweep_rays() of sweep.c does. */
static void sweep_rays(const struct tile *tile, struct share *share)
{
    const struct rf_ray_set *set = tile->set;
    int rays[2] = {0, 0}; /* in this run */
    struct lookups *const lookups = &share->lookups;
    struct sums *const sums = &share->sums;

    clear_run(tile, sums);
    for (int n = 0, end; n < set->count; n = end) {
        const uint64_t weight = set->ray[n].weight;
        int shared;

        if (rf_cancelled(tile->f->exec))
            return;
        set_rays(lookups, set, n);
        end = n + lookups->rays;
        shared = rf_shared_rays(set, n, end);
        rays[0] += lookups->rays;
        rays[1] += shared;
        sort_rays(tile, lookups, shared);
        share->past_slabs = share->past_slabs || lookups->sorted.past_slabs;
        sweep_plane(tile, false, &lookups->sorted, sums);
        sweep_plane(tile, true, &lookups->sorted, sums);
        if (!set->equal && (end == set->count || set->ray[end].weight != weight)) {
            add_run(tile, sums, weight, rays);
            rays[0] = rays[1] = 0;
        }
    }
}

/* Computes the means of rays of equal weight: of some rows first, then of the rows between. */
static void compute_means(const struct tile *tile, bool chroma, struct sums *sums,
                          uint16_t mean[LANES])
{
    const struct rf_kernels *kernels = tile->f->exec->kernels;
    const struct plane *plane = chroma ? &tile->chroma : &tile->luma;
    const int rays = chroma ? tile->set->shared : tile->set->count;
    const int lanes = plane->computed.count * RF_TILE;
    const uint16_t softness = rf_softness(tile->f, &tile->plan, tile->background_blur);
    uint16_t memory[LANES], *computed = plane->computed.step == 1 ? mean : memory;

    if (!tile->weight && !chroma && rf_exceeds_means(&tile->plan))
        rf_clamp_sums(sums->run[0], (uint32_t)rays, lanes);
    if (tile->weight)
        kernels->weighted_means(computed, sums->weighted_run[chroma], sums->weight_run[chroma],
                                lanes);
    else
        kernels->means(computed, sums->run[chroma], rf_mean_scale((uint64_t)rays), lanes);
    if (softness)
        kernels->soften(computed, plane->computed.count, chroma ? 2 : 1,
                        plane->computed.count == plane->rows, softness);
    if (computed == memory && plane->rows == RF_TILE)
        kernels->between_rows(mean, computed, plane->computed.step);
    else if (computed == memory)
        kernels->between_chroma(mean, computed);
}

static void sweep_means(struct tile *tile, struct share *share, struct rf_decode_job *means)
{
    const struct rf_frame *f = tile->f;

    tile->luma.computed = rf_tile_rows(f, &tile->plan, tile->background_blur);
    tile->chroma.computed = tile->chroma.down
                                ? rf_chroma_rows(f, &tile->plan, tile->background_blur)
                                : tile->luma.computed;
    sweep_rays(tile, share);
    if (rf_cancelled(f->exec))
        return;
    compute_means(tile, false, &share->sums, means->luma);
    compute_means(tile, true, &share->sums, means->chroma);
}

/* Computes the means of rays that do not weigh the same. */
static void sweep_sums(struct tile *tile, struct share *share, struct rf_decode_job *means)
{
    const int lanes[2] = {LANES, tile->chroma.rows * RF_TILE};
    struct sums *const sums = &share->sums;
    uint16_t *const mean[2] = {means->luma, means->chroma};

    tile->luma.computed = (struct rf_tile_rows){1, tile->luma.rows};
    tile->chroma.computed = (struct rf_tile_rows){1, tile->chroma.rows};
    memset(sums->sum, 0, sizeof sums->sum);
    memset(sums->weight, 0, sizeof sums->weight);
    sweep_rays(tile, share);
    if (rf_cancelled(tile->f->exec)) /* a cancelled run has no weights to divide by */
        return;
    for (int p = 0; p < 2; p++)
        for (int i = 0; i < lanes[p]; i++) {
            const uint64_t w = sums->weight[p][i], v = (4 * sums->sum[p][i] + w / 2) / w;

            mean[p][i] = (uint16_t)(v < 4 * RF_MOST_MEAN ? v : 4 * RF_MOST_MEAN);
        }
}

static void set_planes(struct tile *tile, int tx, int ty)
{
    const struct rf_chroma_planes *chroma = &tile->f->chroma;
    const int down = chroma->size.down;
    const ptrdiff_t origin = ty * RF_TILE * tile->f->view->stride + tx * RF_TILE;
    const ptrdiff_t at = (ty * RF_TILE >> down) * tile->f->view->stride + tx * RF_TILE;

    tile->range = tile->f->range.at + RF_TILE / RF_CELL * (ty * tile->f->range.stride + tx);
    tile->weight = tile->f->weighted ? tile->f->weight.at + origin : NULL;
    tile->background_weight = tile->f->weighted ? tile->f->background_weight.at + origin : NULL;
    tile->luma = (struct plane){
        .blur = tile->f->blur.at + origin,
        .light = tile->f->smooth.channel[0] + origin,
        .background = tile->f->background.light.channel[0] + origin,
        .rows = RF_TILE,
        .steps = rf_steps_of(&tile->plan),
    };
    tile->chroma = (struct plane){
        .blur = chroma->blur.at + at,
        .light = chroma->smooth.at + at,
        .background = chroma->background.at + at,
        .rows = RF_TILE >> down,
        .steps = 65535 / RF_CHROMA_MAX, /* 8 */
        .down = down,
    };
}

/* Computes means for the blur of the hidden background at each corner of the tile. */
static void sweep_corners(struct tile *tile, int tx, int ty, struct share *share,
                          struct rf_decode_job *means)
{
    const struct rf_corner_layout pixels = {1, 1}, chroma = {2, 1 << tile->chroma.down};
    struct rf_corners corners;

    rf_find_corners(&corners, tile->f, tx, ty);
    share->past_slabs = false;
    for (int k = 0; k < corners.count && !rf_cancelled(tile->f->exec); k++) {
        const bool repeats =
            rf_corner_repeats(&corners, k, tile->f, &tile->plan, share->past_slabs);

        tile->background_blur = corners.blur[k];
        if (!repeats && tile->set->equal)
            sweep_means(tile, share, means);
        else if (!repeats)
            sweep_sums(tile, share, means);
        if (corners.count > 1) {
            rf_add_corner(share->corners[0], means->luma, &corners, k, pixels);
            rf_add_corner(share->corners[1], means->chroma, &corners, k, chroma);
        }
    }
    if (corners.count > 1) {
        rf_corner_means(means->luma, share->corners[0], pixels);
        rf_corner_means(means->chroma, share->corners[1], chroma);
    }
}

void rf_sweep_yuv_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct rf_decode_job means;
    struct tile tile;
    void *const share = rf_share(&f->exec->shares, worker);

    tile.f = f;
    rf_plan_tile(f->view, f->bins, &f->reach, tx, ty, &tile.plan);
    if (tile.plan.sharp) {
        rf_copy_yuv_tile(f, rect);
        return;
    }
    tile.set = rf_choose_ray_set(f->ray_sets, tile.plan.reach, tile.plan.undersampled);
    set_planes(&tile, tx, ty);
    sweep_corners(&tile, tx, ty, share, &means);
    if (rf_cancelled(f->exec))
        return;
    if (f->splats)
        rf_splat_yuv_highlights(&f->splat, &tile.plan, tx, ty, share, means.luma, means.chroma);
    if (f->thin.mattes)
        rf_matte_over_yuv(&f->thin, tx, ty, means.luma, means.chroma);
    rf_encode_yuv_means(f, tx, ty, rect, &means);
}
