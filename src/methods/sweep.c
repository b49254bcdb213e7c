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

/* The pixels of a tile. Sums of up to 65,025 rays of Q12 light stay below 2^28. */
struct lanes {
    uint16_t free[LANES]; /* 0xffff: this pixel's ray has met nothing yet */
    uint32_t light[3][LANES];
};

/* Light of one layer at an offset, for free pixels whose ray meets it there. */
static void add_hits(const struct rf_frame *f, const struct rf_slab *slab, ptrdiff_t from,
                     struct lanes *lanes)
{
    const struct refocus_renderer *r = f->r;

    for (int y = 0; y < RF_TILE; y++) {
        const ptrdiff_t at = from + y * r->stride;
        const int16_t *restrict s = r->front.blur + at;
        const uint16_t *restrict red = r->smooth[0] + at;
        const uint16_t *restrict green = r->smooth[1] + at;
        const uint16_t *restrict blue = r->smooth[2] + at;
        uint16_t *restrict is_free = lanes->free + y * RF_TILE;
        uint32_t *restrict sum0 = lanes->light[0] + y * RF_TILE;
        uint32_t *restrict sum1 = lanes->light[1] + y * RF_TILE;
        uint32_t *restrict sum2 = lanes->light[2] + y * RF_TILE;

        for (int x = 0; x < RF_TILE; x++) {
            const uint16_t above = (uint16_t)(s[x] - slab->low);
            const uint16_t hit = above <= slab->width ? is_free[x] : 0;

            is_free[x] &= (uint16_t)~hit;
            sum0[x] += red[x] & hit;
            sum1[x] += green[x] & hit;
            sum2[x] += blue[x] & hit;
        }
    }
}

static void add_behind(const struct rf_frame *f, ptrdiff_t from, struct lanes *lanes)
{
    const struct refocus_renderer *r = f->r;

    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < RF_TILE; y++) {
            const uint16_t *restrict light = r->behind.light[c] + from + y * r->stride;
            const uint16_t *restrict is_free = lanes->free + y * RF_TILE;
            uint32_t *restrict sum = lanes->light[c] + y * RF_TILE;

            for (int x = 0; x < RF_TILE; x++)
                sum[x] += light[x] & is_free[x];
        }
    }
}

/* As above with eq. 5's weights: each pixel counts w times. */
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

static void add_lanes(const struct lanes *lanes, uint64_t weight, struct rf_sums *sums)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            sums->light[c][i] += weight * lanes->light[c][i];
}

/* Rays come in runs of equal weight; a run is summed plainly and weighted once. */
static void sweep_rays(const struct rf_frame *f, const struct rf_tile_plan *plan,
                       const struct rf_ray_set *set, ptrdiff_t origin, int behind,
                       struct rf_sums *sums)
{
    struct lanes lanes;

    memset(sums, 0, sizeof *sums);
    memset(&lanes, 0, sizeof lanes);
    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];

        memset(lanes.free, 0xff, sizeof lanes.free);
        for (int i = 0; i < plan->slabs; i++)
            add_hits(f, &plan->slab[i], shifted(f, origin, ray, plan->slab[i].centre),
                     &lanes);
        if (!plan->uniform)
            add_behind(f, shifted(f, origin, ray, behind), &lanes);
        if (n + 1 == set->count || ray[1].weight != ray->weight) {
            add_lanes(&lanes, ray->weight, sums);
            memset(&lanes, 0, sizeof lanes);
        }
    }
    for (int i = 0; i < LANES; i++)
        sums->weight[i] = set->total_weight;
}

static void sweep_weighted(const struct rf_frame *f, const struct rf_tile_plan *plan,
                           const struct rf_ray_set *set, ptrdiff_t origin, int behind,
                           struct rf_sums *sums)
{
    uint16_t is_free[LANES];

    memset(sums, 0, sizeof *sums);
    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];

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
    struct rf_sums sums;

    (void)worker;
    rf_plan_tile(r, f->scale, tx, ty, f->aperture->shape == RF_SHAPE_MASK, &plan);
    if (plan.sharp) {
        rf_copy_tile(f, rect);
        return;
    }
    set = rf_rays_for(r, plan.reach);
    if (f->weighted)
        sweep_weighted(f, &plan, set, origin, behind, &sums);
    else
        sweep_rays(f, &plan, set, origin, behind, &sums);
    rf_encode_tile(f, rect, &sums);
}
