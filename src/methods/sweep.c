/* sweep.c: two layers, front-most hit, by a sweep over the disparities in reach.
 *
 * Yang et al. 2016 ask for the front-most q on the ray of p with q = p + u s(q) (eq. 4),
 * relaxed to half a pixel. Over a tile, few signed blurs s can be met at all. They are
 * covered, nearest first, by slabs one pixel wide. For one ray and one slab the offset
 * u s_slab is the same for the whole tile; each pixel that is still without a hit looks
 * there, and has one if the blur found lies in the slab. What is still free at the end
 * looks past everything, into the background layer.
 *
 * This is plain C that states the arithmetic; sums are whole numbers, so their order does
 * not matter.
 */
#include "methods/method.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Offsets of some rays at the centre of a slab, in elements of the planes. */
static void set_offsets(int32_t offset[RF_RAY_CHUNK], const struct refocus_ray *ray, int rays,
                        int blur, ptrdiff_t stride)
{
    for (int n = 0; n < rays; n++)
        offset[n] = rf_offset(ray[n].v, blur) * (int32_t)stride + rf_offset(ray[n].u, blur);
}

/* What is summed of a tile: plainly, or light times weight and weights. */
union tally {
    uint32_t plain[3][LANES];
    uint64_t weighted[4][LANES];
};

/* A run of rays of equal weight is at its end: it counts that often. */
static void add_run(const struct rf_frame *f, const union tally *run, uint64_t ray_weight,
                    uint64_t rays, struct rf_sums *sums)
{
    for (int i = 0; i < LANES; i++) {
        for (int c = 0; c < 3; c++)
            sums->light[c][i] +=
                ray_weight * (f->weighted ? run->weighted[c][i] : run->plain[c][i]);
        sums->weight[i] += ray_weight * (f->weighted ? run->weighted[3][i] : rays);
    }
}

/* Rays from `first` on that weigh the same, RF_RAY_CHUNK at the most. */
static int chunk_of(const struct rf_ray_set *set, int first)
{
    int n = 1;

    while (n < RF_RAY_CHUNK && first + n < set->count &&
           set->ray[first + n].weight == set->ray[first].weight)
        n++;
    return n;
}

/* Rays come in runs of equal weight; a run is summed plainly and counts as often as it weighs.
 * Sums of a run, 65,025 rays of Q12 light at the most, stay below 2^30. That of a set of equal
 * rays is left in `run`; others are added up in `sums`. */
static void sweep_rays(const struct rf_frame *f, const struct rf_tile_plan *plan,
                       const struct rf_ray_set *set, int tx, int ty, union tally *run,
                       struct rf_sums *sums)
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t origin = ty * RF_TILE * r->stride + tx * RF_TILE;
    /* One blur of the background for the tile, that of its middle, keeps the offsets of a
     * ray constant; looking it up for each pixel measured no better. */
    const int behind = f->weighted ? r->bins[(size_t)ty * r->tiles_x + tx].behind
                                   : r->behind.blur[rf_tile_middle(r, tx, ty)];
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    int32_t weight_offset[RF_MAX_SLABS][RF_RAY_CHUNK];
    struct rf_sweep_job job = {
        .blur = r->front.blur + origin,
        .behind = r->behind.light[0] + origin,
        .stride = r->stride,
        .pitch = r->pitch,
        .slabs = plan->slabs,
        .slab = plan->slab,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])offset,
        .uniform = plan->uniform,
        .bright = f->bright,
        .weight = r->weight + ty * RF_TILE * r->weight_stride + tx * RF_TILE,
        .behind_weight = (const uint16_t *)r->behind.blur + origin,
        .weight_stride = r->weight_stride,
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])weight_offset,
    };
    int rays = 0; /* in this run */

    memset(run, 0, sizeof *run);
    for (int n = 0; n < set->count; n += job.rays) {
        const struct refocus_ray *ray = &set->ray[n];

        job.rays = chunk_of(set, n);
        rays += job.rays;
        for (int k = 0; k < plan->slabs; k++) {
            set_offsets(offset[k], ray, job.rays, plan->slab[k].centre, r->stride);
            if (f->weighted)
                set_offsets(weight_offset[k], ray, job.rays, plan->slab[k].centre,
                            r->weight_stride);
        }
        set_offsets(offset[plan->slabs], ray, job.rays, behind, r->stride);
        if (f->weighted)
            r->kernels.sweep_weighted(run->weighted, &job);
        else
            r->kernels.sweep(run->plain, &job);
        if (!set->equal &&
            (n + job.rays == set->count || ray[job.rays].weight != ray->weight)) {
            add_run(f, run, ray->weight, (uint64_t)rays, sums);
            memset(run, 0, sizeof *run);
            rays = 0;
        }
    }
}

void rf_sweep_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct refocus_renderer *r = f->r;
    const struct rf_ray_set *set;
    struct rf_tile_plan plan;
    uint16_t mean[3][LANES];
    union tally run;

    (void)worker;
    rf_plan_tile(r, f->scale, tx, ty, f->aperture->shape == RF_SHAPE_MASK, &plan);
    if (plan.sharp) {
        rf_copy_tile(f, rect);
        return;
    }
    set = rf_rays_for(r, plan.reach, plan.lamp);
    if (!set->equal) {
        struct rf_sums sums;

        memset(&sums, 0, sizeof sums);
        sweep_rays(f, &plan, set, tx, ty, &run, &sums);
        rf_encode_tile(f, rect, &sums);
        return;
    }
    sweep_rays(f, &plan, set, tx, ty, &run, NULL);
    for (int c = 0; c < 3; c++) {
        if (f->weighted)
            r->kernels.weighted_means(mean[c], run.weighted[c], run.weighted[3], LANES);
        else
            r->kernels.means(mean[c], run.plain[c], rf_mean_scale((uint64_t)set->count),
                             LANES);
    }
    rf_encode_means(f, rect, mean);
}
