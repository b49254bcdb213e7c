/* search.c: randomized intersection search, Yang et al. 2016, section "Randomized
 * Intersection Searching".
 *
 * A ray (u, v) of pixel p starts with the disparity found where it would hit the nearest plane, d =
 * 1: at p + (u, v) K (df - 1), the same offset for every pixel. A guess d leads to the pixel q = p
 * + (u, v) K (df - d) (eq. 4). If the disparity at q confirms the guess to half a pixel, |u| K |d_q
 * - d| <= 1/2, q is an intersection. If not, d_q is the next guess. After T tests the last pixel
 * looked at is used, unless it is no intersection and farther than p: then p itself is used (or, by
 * option, the mirrored pixel, or the hidden background).
 *
 * An example: K = 20, df = 0.5, and the ray is (1, 0). The first guess, d = 1, leads 10 pixels to
 * the left, where the disparity is 0.4: 20 x 0.6 is 12 pixels, so it is not confirmed. The next
 * guess, 0.4, leads 2 pixels to the right, where the disparity is 0.41: 20 x 0.01 is 0.2 pixels,
 * and the ray hits this pixel.
 */
#include "gather/frame.h"
#include "image/viewport.h"

#include <string.h>

/* The pixel that a ray ends at. */
struct hit {
    ptrdiff_t at;
    int blur;   /* the guess that led there, Q7.8 */
    bool valid; /* the pixel confirms the guess */
};

static struct hit search(const struct rf_frame *f, ptrdiff_t p, const struct refocus_ray *ray,
                         ptrdiff_t start, int within, int tests)
{
    const int16_t *s = f->blur.at;
    struct hit hit = {p, s[p + start], false};
    int next = hit.blur;

    while (tests-- > 0 && !hit.valid) {
        int apart;

        hit.blur = next;
        hit.at = p + rf_offset(ray->v, hit.blur) * f->view->stride + rf_offset(ray->u, hit.blur);
        next = s[hit.at];
        apart = next - hit.blur;
        hit.valid = apart <= within && -apart <= within;
    }
    return hit;
}

/* Chooses the pixel of *light that the light of a ray comes from. */
static ptrdiff_t resolve(const struct rf_frame *f, ptrdiff_t p, const struct refocus_ray *ray,
                         struct hit hit, uint16_t *const **light)
{
    *light = f->light.channel;
    if (hit.valid || f->blur.at[hit.at] <= f->blur.at[p])
        return hit.at;
    if (f->params->background) {
        const int s = f->background.blur.at[p];

        *light = f->background.light.channel;
        return p + rf_offset(ray->v, s) * f->view->stride + rf_offset(ray->u, s);
    }
    if (f->params->mirror)
        return p - rf_offset(ray->v, hit.blur) * f->view->stride - rf_offset(ray->u, hit.blur);
    return p;
}

/* At most RF_RAY_CHUNK rays of equal weight, and the cells of their first guesses. */
struct chunk {
    struct rf_search_rays rays;
    int32_t cell[RF_RAY_CHUNK];
};

static void set_chunk(struct chunk *chunk, const struct rf_frame *f, const struct refocus_ray *ray,
                      int n)
{
    struct rf_search_rays *rays = &chunk->rays;

    rays->rays = n;
    for (int i = 0; i < n; i++) {
        rays->u[i] = ray[i].u;
        rays->v[i] = ray[i].v;
    }
    f->exec->kernels->aim(rays->start, chunk->cell, rays->u, rays->v, rf_nearest_blur(f),
                          (int32_t)f->view->stride, (int32_t)f->range.stride, n);
    f->exec->kernels->tolerances(rays->within, rays->u, rays->v, n);
}

/* Follows the paper's own rule, by kernels. Rays that are settled for the strip as a whole are
 * added as the sweep adds rays that need no test; the others are searched. */
static void search_strip(const struct rf_frame *f, const struct chunk *chunk, int tx, int y,
                         uint32_t *const sum[3])
{
    const struct rf_search_rays *rays = &chunk->rays;
    const ptrdiff_t at = y * f->view->stride + tx * RF_TILE;
    uint8_t settled[RF_RAY_CHUNK];
    int32_t offset[RF_RAY_CHUNK];
    struct rf_search_rays left;
    struct rf_sorted_rays sorted;
    const struct rf_sweep_job sweep = {
        .blur = f->blur.at + at,
        .stride = f->view->stride,
        .pitch = f->light.channel[1] - f->light.channel[0],
        .rays = &sorted,
        .steps = 16,
        .lanes = RF_STRIP_LANES,
    };
    const struct rf_search_job search = {
        .blur = f->blur.at + at,
        .light = {f->light.channel[0] + at, f->light.channel[1] + at, f->light.channel[2] + at},
        .stride = f->view->stride,
        .tests = f->params->iterations,
        .rays = &left,
    };
    int add = 0, test = 0;

    f->exec->kernels->settle(settled, offset,
                             f->range.at + y / RF_CELL * f->range.stride + tx * (RF_TILE / RF_CELL),
                             chunk->cell, rays, f->params->iterations, (int32_t)f->view->stride,
                             (int32_t)f->range.stride);
    for (int n = 0; n < rays->rays; n++) {
        left.start[test] = rays->start[n];
        left.u[test] = rays->u[n];
        left.v[test] = rays->v[n];
        left.within[test] = rays->within[n];
        sorted.tests[add] = 0;
        sorted.last[add] = f->light.channel[0] + at + offset[n];
        test += !settled[n];
        add += settled[n];
    }
    left.rays = test;
    sorted.rays = add;
    if (add)
        f->exec->kernels->sweep((uint32_t *const[4]){sum[0], sum[1], sum[2], NULL}, &sweep);
    if (test)
        f->exec->kernels->search(sum, &search);
}

static void search_runs(const struct rf_frame *f, int tx, int ty, const struct rf_ray_set *set,
                        struct rf_sums *sums)
{
    uint32_t run[3][RF_TILE * RF_TILE];
    struct chunk chunk;

    memset(run, 0, sizeof run);
    for (int n = 0, rays; n < set->count; n += rays) {
        const struct refocus_ray *ray = &set->ray[n];

        if (rf_cancelled(f->exec))
            return;
        rays = rf_rays_of_equal_weight(set, n);
        set_chunk(&chunk, f, ray, rays);
        for (int i = 0; i < RF_TILE * RF_TILE; i += RF_STRIP_LANES)
            search_strip(f, &chunk, tx, ty * RF_TILE + i / RF_TILE,
                         (uint32_t *const[3]){run[0] + i, run[1] + i, run[2] + i});
        if (n + rays < set->count && ray[rays].weight == ray->weight)
            continue;
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < RF_TILE * RF_TILE; i++)
                sums->light[c][i] += (uint64_t)ray->weight * run[c][i];
        memset(run, 0, sizeof run);
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        sums->weight[i] = set->total_weight;
}

/* Searches pixel by pixel, as weights, the mirrored pixel and the hidden background require. */
static void search_pixels(const struct rf_frame *f, struct rf_rect rect,
                          const struct rf_ray_set *set, struct rf_sums *sums)
{
    const int nearest = rf_nearest_blur(f);

    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];
        const ptrdiff_t start =
            rf_offset(ray->v, nearest) * f->view->stride + rf_offset(ray->u, nearest);
        int32_t within;

        if (rf_cancelled(f->exec))
            return;
        f->exec->kernels->tolerances(&within, &ray->u, &ray->v, 1);
        for (int y = rect.y0; y < rect.y1; y++) {
            for (int x = rect.x0; x < rect.x1; x++) {
                const ptrdiff_t p = y * f->view->stride + x;
                const int i = y % RF_TILE * RF_TILE + x % RF_TILE;
                const struct hit hit = search(f, p, ray, start, within, f->params->iterations);
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
    const struct rf_ray_set *set = &f->ray_sets->set[f->ray_sets->preset];
    struct rf_sums sums;

    (void)worker;
    memset(&sums, 0, sizeof sums);
    if (f->weighted || f->params->mirror || f->params->background)
        search_pixels(f, rect, set, &sums);
    else
        search_runs(f, tx, ty, set, &sums);
    if (!rf_cancelled(f->exec)) /* a cancelled run has no weights to divide by */
        rf_encode_tile(f, rect, &sums);
}
