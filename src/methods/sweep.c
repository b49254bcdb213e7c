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
#include "renderer/bands.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Hits with eq. 5's weights: each pixel counts w times. Slab NULL: whatever is there. */
static void weigh_hits(const struct rf_frame *f, uint16_t *const light[3],
                       const struct rf_slab *slab, ptrdiff_t from, uint32_t ray_weight,
                       uint16_t *is_free, struct rf_sums *sums)
{
    for (int i = 0; i < LANES; i++) {
        const ptrdiff_t q = from + i / RF_TILE * f->r->stride + i % RF_TILE;
        uint64_t w;

        if (!is_free[i] ||
            (slab && (uint16_t)(f->r->front.blur[q] - slab->low) > slab->width))
            continue;
        w = (uint64_t)rf_weight_of(f, light, q) * ray_weight;
        is_free[i] = 0;
        sums->weight[i] += w;
        for (int c = 0; c < 3; c++)
            sums->light[c][i] += w * light[c][q];
    }
}

static ptrdiff_t shifted(const struct rf_frame *f, ptrdiff_t origin,
                         const struct refocus_ray *ray, int blur)
{
    return origin + rf_offset(ray->v, blur) * f->r->stride + rf_offset(ray->u, blur);
}

static void add_run(uint32_t run[3][LANES], uint64_t weight, struct rf_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < LANES; i++)
            sums->light[c][i] += weight * run[c][i];
        memset(run[c], 0, sizeof run[c]);
    }
}

/* Offsets of some rays at the centre of a slab, in elements of the planes. */
static void set_offsets(int32_t offset[RF_RAY_CHUNK], const struct refocus_ray *ray, int rays,
                        int blur, ptrdiff_t stride)
{
    for (int n = 0; n < rays; n++)
        offset[n] = rf_offset(ray[n].v, blur) * (int32_t)stride + rf_offset(ray[n].u, blur);
}

/* Rays come in runs of equal weight; a run is summed plainly and weighted once. Sums of
 * a run, 65,025 rays of Q12 light at the most, stay below 2^28. The sums of a set that is one
 * run are left in `run`; others are added up in `sums`. */
static void sweep_rays(const struct rf_frame *f, const struct rf_tile_plan *plan,
                       const struct rf_ray_set *set, ptrdiff_t origin, int behind,
                       uint32_t run[3][LANES], struct rf_sums *sums)
{
    const struct refocus_renderer *r = f->r;
    int32_t offset[RF_MAX_SLABS + 1][RF_RAY_CHUNK];
    struct rf_sweep_job job = {
        .blur = r->front.blur + origin,
        .behind = r->behind.light[0] + origin,
        .stride = r->stride,
        .pitch = r->pitch,
        .slabs = plan->slabs,
        .slab = plan->slab,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])offset,
        .uniform = plan->uniform,
        .bright = f->params->highlight_gain > 1,
    };

    memset(run, 0, 3 * sizeof run[0]);
    for (int n = 0; n < set->count; n += job.rays) {
        const struct refocus_ray *ray = &set->ray[n];

        if (rf_cancelled(r))
            return;
        job.rays = 1;
        while (job.rays < RF_RAY_CHUNK && n + job.rays < set->count &&
               ray[job.rays].weight == ray->weight)
            job.rays++;
        for (int k = 0; k < plan->slabs; k++)
            set_offsets(offset[k], ray, job.rays, plan->slab[k].centre, r->stride);
        set_offsets(offset[plan->slabs], ray, job.rays, behind, r->stride);
        r->kernels.sweep(run, &job);
        if (!set->equal &&
            (n + job.rays == set->count || ray[job.rays].weight != ray->weight))
            add_run(run, ray->weight, sums);
    }
}

static void sweep_weighted(const struct rf_frame *f, const struct rf_tile_plan *plan,
                           const struct rf_ray_set *set, ptrdiff_t origin, int behind,
                           struct rf_sums *sums)
{
    uint16_t is_free[LANES];

    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];

        if (rf_cancelled(f->r))
            return;
        memset(is_free, 0xff, sizeof is_free);
        for (int i = 0; i < plan->slabs; i++)
            weigh_hits(f, f->r->smooth, &plan->slab[i],
                       shifted(f, origin, ray, plan->slab[i].centre), ray->weight, is_free,
                       sums);
        weigh_hits(f, f->r->behind.light, NULL, shifted(f, origin, ray, behind),
                   ray->weight, is_free, sums);
    }
}

void rf_sweep_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t origin = ty * RF_TILE * r->stride + tx * RF_TILE;
    /* One blur of the background for the tile, that of its middle, keeps the offsets of a
     * ray constant; looking it up for each pixel measured no better. */
    const int behind = r->behind.blur[origin + RF_TILE / 2 * (r->stride + 1)];
    const struct rf_ray_set *set;
    struct rf_tile_plan plan;

    (void)worker;
    rf_plan_tile(r, f->scale, tx, ty, f->aperture->shape == RF_SHAPE_MASK, &plan);
    if (plan.sharp) {
        rf_copy_tile(f, rect);
        return;
    }
    set = rf_rays_for(r, plan.reach, plan.lamp);
    if (set->equal && !f->weighted) {
        const uint32_t scale = rf_mean_scale((uint64_t)set->count);
        uint16_t mean[3][LANES];
        uint32_t run[3][LANES];

        sweep_rays(f, &plan, set, origin, behind, run, NULL);
        for (int c = 0; c < 3; c++)
            r->kernels.means(mean[c], run[c], scale, LANES);
        rf_encode_means(f, rect, mean);
    } else {
        struct rf_sums sums;
        uint32_t run[3][LANES];

        memset(&sums, 0, sizeof sums);
        if (f->weighted) {
            sweep_weighted(f, &plan, set, origin, behind, &sums);
        } else {
            sweep_rays(f, &plan, set, origin, behind, run, &sums);
            for (int i = 0; i < LANES; i++)
                sums.weight[i] = set->total_weight;
        }
        if (!rf_cancelled(r)) /* else no weights */
            rf_encode_tile(f, rect, &sums);
    }
}
