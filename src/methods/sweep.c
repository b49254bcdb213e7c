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

struct lanes {
    uint16_t free[LANES]; /* 0xffff: this pixel's ray has met nothing yet */
    uint32_t light[3][LANES];
};

static void add_hits(const struct refocus_renderer *r, const struct rf_slab *slab,
                     ptrdiff_t from, struct lanes *lanes)
{
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

static void add_behind(const struct refocus_renderer *r, const struct refocus_ray *ray,
                       ptrdiff_t from, struct lanes *lanes)
{
    for (int i = 0; i < LANES; i++) {
        const ptrdiff_t p = from + i / RF_TILE * r->stride + i % RF_TILE;
        const int s = r->behind.blur[p];
        const ptrdiff_t q = p + rf_offset(ray->v, s) * r->stride + rf_offset(ray->u, s);

        if (!lanes->free[i])
            continue;
        for (int c = 0; c < 3; c++)
            lanes->light[c][i] += r->behind.light[c][q];
    }
}

void rf_sweep_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t origin = ty * RF_TILE * r->stride + tx * RF_TILE;
    const struct rf_ray_set *set;
    struct rf_tile_plan plan;
    struct rf_sums sums;
    struct lanes lanes;

    (void)worker;
    rf_plan_tile(r, f->scale, tx, ty, f->aperture->shape == RF_SHAPE_MASK, &plan);
    if (plan.sharp) {
        rf_copy_tile(f, rect);
        return;
    }
    set = rf_rays_for(r, plan.reach);
    memset(&lanes, 0, sizeof lanes);
    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];

        memset(lanes.free, 0xff, sizeof lanes.free);
        for (int i = 0; i < plan.slabs; i++)
            add_hits(r, &plan.slab[i],
                     origin + rf_offset(ray->v, plan.slab[i].centre) * r->stride +
                         rf_offset(ray->u, plan.slab[i].centre),
                     &lanes);
        if (!plan.uniform)
            add_behind(r, ray, origin, &lanes);
    }
    for (int i = 0; i < LANES; i++) {
        for (int c = 0; c < 3; c++)
            sums.light[c][i] = lanes.light[c][i];
        sums.weight[i] = (uint64_t)set->count;
    }
    rf_encode_tile(f, rect, &sums);
}
