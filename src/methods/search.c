/* search.c: randomized intersection search, Yang et al. 2016, section "Randomized
 * Intersection Searching".
 *
 * A ray (u, v) of pixel p starts with the disparity found where it would meet the nearest
 * plane, d = 1: at p + (u, v) K (df - 1), the same offset for every pixel. A guess d leads to the
 * pixel q = p + (u, v) K (df - d) (eq. 4). If the disparity at q confirms the guess to half
 * a pixel, |u| K |d_q - d| <= 1/2, q is an intersection. If not, d_q is the next guess. After T
 * tests the last pixel looked at is taken, unless it is no intersection and farther than
 * p: then p itself is (or, by option, the mirrored pixel, or the background layer).
 */
#include "methods/method.h"
#include "renderer/bands.h"

#include <math.h>
#include <string.h>

/* Largest |s - s'| that half a pixel allows a ray: 1/2 / |u|, in Q7.8. */
static int tolerance(const struct refocus_ray *ray)
{
    const double length = sqrt((double)ray->u * ray->u + (double)ray->v * ray->v);
    const double most = length > 0 ? 4194304.0 / length : 65535; /* 2^22 = half in Q23 */

    return most > 65535 ? 65535 : (int)most;
}

struct hit {
    ptrdiff_t at;
    int blur; /* that led there */
    bool valid;
};

static struct hit search(const struct refocus_renderer *r, ptrdiff_t p,
                         const struct refocus_ray *ray, ptrdiff_t start, int within, int tests)
{
    const int16_t *s = r->front.blur;
    struct hit hit = {p, s[p + start], false};
    int next = hit.blur;

    while (tests-- > 0 && !hit.valid) {
        int apart;

        hit.blur = next;
        hit.at = p + rf_offset(ray->v, hit.blur) * r->stride + rf_offset(ray->u, hit.blur);
        next = s[hit.at];
        apart = next - hit.blur;
        hit.valid = apart <= within && -apart <= within;
    }
    return hit;
}

/* Where the light of a ray comes from: a pixel of *light. */
static ptrdiff_t resolve(const struct rf_frame *f, ptrdiff_t p,
                         const struct refocus_ray *ray, struct hit hit,
                         uint16_t *const **light)
{
    const struct refocus_renderer *r = f->r;

    *light = r->front.light;
    if (hit.valid || r->front.blur[hit.at] <= r->front.blur[p])
        return hit.at;
    if (f->params->background) {
        const int s = r->behind.blur[p];

        *light = r->behind.light;
        return p + rf_offset(ray->v, s) * r->stride + rf_offset(ray->u, s);
    }
    if (f->params->mirror)
        return p - rf_offset(ray->v, hit.blur) * r->stride - rf_offset(ray->u, hit.blur);
    return p;
}

/* s of the nearest plane, d = 1. */
static int nearest_blur(const struct rf_frame *f)
{
    return -(int)(((uint32_t)(65535 - f->focus.disparity) * f->focus.radius + (1 << 15)) >>
                  16);
}

/* The paper's own rule, by the kernel: some rays of equal weight into `run`. */
static void search_run(const struct rf_frame *f, ptrdiff_t origin,
                       const struct refocus_ray *ray, int rays,
                       uint32_t run[3][RF_TILE * RF_TILE])
{
    const struct refocus_renderer *r = f->r;
    const int nearest = nearest_blur(f);
    struct rf_search_ray own[RF_RAY_CHUNK];
    struct rf_search_job job = {
        .blur = r->front.blur + origin,
        .light = {r->front.light[0] + origin, r->front.light[1] + origin,
                  r->front.light[2] + origin},
        .stride = r->stride,
        .tests = f->params->iterations,
        .rays = rays,
        .lanes = RF_TILE,
        .ray = own,
    };

    for (int n = 0; n < rays; n++)
        own[n] = (struct rf_search_ray){
            .start = rf_offset(ray[n].v, nearest) * (int32_t)r->stride +
                     rf_offset(ray[n].u, nearest),
            .u = ray[n].u,
            .v = ray[n].v,
            .within = tolerance(&ray[n]),
        };
    r->kernels.search(run, &job);
}

static void search_runs(const struct rf_frame *f, ptrdiff_t origin,
                        const struct rf_ray_set *set, struct rf_sums *sums)
{
    uint32_t run[3][RF_TILE * RF_TILE];

    for (int n = 0, rays; n < set->count; n += rays) {
        const struct refocus_ray *ray = &set->ray[n];

        rays = 1;
        while (rays < RF_RAY_CHUNK && n + rays < set->count &&
               ray[rays].weight == ray->weight)
            rays++;
        if (rf_cancelled(f->r))
            return;
        memset(run, 0, sizeof run);
        search_run(f, origin, ray, rays, run);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < RF_TILE * RF_TILE; i++)
                sums->light[c][i] += (uint64_t)ray->weight * run[c][i];
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        sums->weight[i] = set->total_weight;
}

/* With weights, the mirrored pixel or the background layer: pixel by pixel. */
static void search_pixels(const struct rf_frame *f, struct rf_rect rect,
                          const struct rf_ray_set *set, struct rf_sums *sums)
{
    const struct refocus_renderer *r = f->r;
    const int nearest = nearest_blur(f);

    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];
        const ptrdiff_t start = rf_offset(ray->v, nearest) * r->stride +
                                rf_offset(ray->u, nearest);
        const int within = tolerance(ray);

        if (rf_cancelled(f->r))
            return;
        for (int y = rect.y0; y < rect.y1; y++) {
            for (int x = rect.x0; x < rect.x1; x++) {
                const ptrdiff_t p = y * r->stride + x;
                const int i = y % RF_TILE * RF_TILE + x % RF_TILE;
                const struct hit hit =
                    search(r, p, ray, start, within, f->params->iterations);
                uint16_t *const *light;
                const ptrdiff_t q = resolve(f, p, ray, hit, &light);
                const uint64_t w = (uint64_t)rf_weight_of(f, light, q) * ray->weight;

                sums->weight[i] += w;
                for (int c = 0; c < 3; c++)
                    sums->light[c][i] += w * light[c][q];
            }
        }
    }
}

void rf_search_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct rf_ray_set *set = &f->r->set[f->r->preset];
    struct rf_sums sums;

    (void)worker;
    memset(&sums, 0, sizeof sums);
    if (f->weighted || f->params->mirror || f->params->background)
        search_pixels(f, rect, set, &sums);
    else
        search_runs(f, ty * RF_TILE * f->r->stride + tx * RF_TILE, set, &sums);
    if (!rf_cancelled(f->r)) /* else no weights */
        rf_encode_tile(f, rect, &sums);
}
