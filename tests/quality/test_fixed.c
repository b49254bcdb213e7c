/* test_fixed.c: measures what fixed point costs: the methods once more in double precision, on a
 * photo.
 *
 * Light by the exact curve, blur and offsets as real numbers until a pixel has to be named,
 * means without rounding. The same rays, the same plan of slabs, the same background layer.
 * Rounding a coordinate the other way at a tie takes a neighbouring pixel, so bits may
 * differ; 55 dB is the bound.
 *
 *     test-fixed FOLDER    with allfocus.png and disparity.png
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/settings.h>

#include "gather/frame.h"
#include "metrics.h"
#include "png_io.h"
#include "renderer/renderer.h"
#include "tiles/tiles.h"

static const double bound_db = 55;

struct scene {
    int width, height;
    uint8_t *photo;
    uint16_t *disparity;
    double K, df;
};

static double to_light(int code)
{
    const double x = code / 255.0;

    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static uint8_t to_code(double light)
{
    const double x = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;

    return (uint8_t)floor(255 * x + 0.5);
}

static size_t pixel_at(const struct scene *s, int x, int y)
{
    x = x < 0 ? 0 : x >= s->width ? s->width - 1 : x;
    y = y < 0 ? 0 : y >= s->height ? s->height - 1 : y;
    return (size_t)y * (size_t)s->width + (size_t)x;
}

static double blur_at(const struct scene *s, size_t q)
{
    return s->K * (s->df - s->disparity[q] / 65535.0);
}

/* The pixel that ray (u, v) of (x, y) hits at blur s. */
static size_t offset(const struct scene *s, int x, int y, const struct refocus_ray *ray,
                     double blur)
{
    return pixel_at(s, x + (int)floor(ray->u / 32768.0 * blur + 0.5),
                    y + (int)floor(ray->v / 32768.0 * blur + 0.5));
}

/* Randomized intersection search, Yang et al. 2016: see src/gather/search.c. */
static size_t search(const struct scene *s, int x, int y, const struct refocus_ray *ray, int tests)
{
    const double length = hypot(ray->u, ray->v) / 32768;
    const size_t p = pixel_at(s, x, y);
    double guess, found = blur_at(s, offset(s, x, y, ray, s->K * (s->df - 1)));
    size_t q;

    do {
        guess = found;
        q = offset(s, x, y, ray, guess);
        found = blur_at(s, q);
    } while (length * fabs(found - guess) > 0.5 && --tests > 0);
    if (length * fabs(found - guess) > 0.5 && found > blur_at(s, p))
        return p;
    return q;
}

static void search_all(const struct scene *s, const double light[256], int tests, uint8_t *out)
{
    static struct refocus_ray rays[64];
    struct refocus_aperture *disc;

    if (refocus_aperture_create_disc(&disc) || refocus_aperture_rays(disc, 64, rays))
        exit(1);
    refocus_aperture_destroy(&disc);
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            double sum[3] = {0};

            for (int n = 0; n < 64; n++) {
                const size_t q = search(s, x, y, &rays[n], tests);
                for (int c = 0; c < 3; c++)
                    sum[c] += light[s->photo[3 * q + (size_t)c]];
            }
            for (int c = 0; c < 3; c++)
                *out++ = to_code(sum[c] / 64);
        }
    }
}

/* One ray of the sweep: the first slab in which something is hit, else the background. */
static void sweep_ray(const struct scene *s, const struct refocus_renderer *r,
                      const struct rf_tile_plan *plan, const struct refocus_ray *ray, int x, int y,
                      double background_blur, const double light[256], double sum[3])
{
    for (int i = 0; i < plan->slabs; i++) {
        const size_t q = offset(s, x, y, ray, plan->slab[i].centre / 256.0);
        const double above = 256 * blur_at(s, q) - plan->slab[i].low;

        if (above >= -0.5 && above < plan->slab[i].width + 0.5) {
            for (int c = 0; c < 3; c++)
                sum[c] += light[s->photo[3 * q + (size_t)c]];
            return;
        }
    }
    const int dx = (int)floor(ray->u / 32768.0 * background_blur + 0.5);
    const int dy = (int)floor(ray->v / 32768.0 * background_blur + 0.5);
    for (int c = 0; c < 3; c++)
        sum[c] += r->background.light.channel[c][(y + dy) * r->view.stride + x + dx] /
                  (double)RF_LIGHT_MAX;
}

static void sweep_all(const struct scene *s, const struct refocus_renderer *r,
                      const double light[256], uint8_t *out)
{
    const float largest = (float)(s->K * fmax(s->df, 1 - s->df));
    const struct rf_bin_scale scale = rf_bin_scale_of(largest, 0);
    struct rf_reach reach;
    struct rf_tile_plan plan;

    rf_reach_init(&reach, scale, largest, r->view.pad, false);
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++, out += 3) {
            const int tx = x / RF_TILE, ty = y / RF_TILE;
            const ptrdiff_t middle =
                (ty * RF_TILE + RF_TILE / 2) * r->view.stride + tx * RF_TILE + RF_TILE / 2;
            double sum[3] = {0};

            if (x % RF_TILE == 0)
                rf_plan_tile(&r->view, r->bins, &reach, tx, ty, &plan);
            if (plan.sharp) {
                memcpy(out, s->photo + 3 * pixel_at(s, x, y), 3);
                continue;
            }
            const struct rf_ray_set *set = rf_choose_ray_set(&r->ray_sets, plan.reach, false);
            for (int n = 0; n < set->count; n++)
                sweep_ray(s, r, &plan, &set->ray[n], x, y, r->background.blur.at[middle] / 256.0,
                          light, sum);
            for (int c = 0; c < 3; c++)
                out[c] = to_code(sum[c] / set->count);
        }
    }
}

/* The scene as the sweep takes it: silhouettes of bright things have their depth
 * (highlights/highlights.h). */
static struct scene with_silhouettes(const struct scene *s, const struct refocus_renderer *r)
{
    const struct rf_silhouettes *list = &r->photo.silhouettes;
    const size_t size = (size_t)s->width * (size_t)s->height * sizeof *s->disparity;
    struct scene patched = *s;

    if (!(patched.disparity = malloc(size)))
        exit(1);
    memcpy(patched.disparity, s->disparity, size);
    for (uint32_t i = 0; i < list->count; i++) {
        const struct rf_silhouette *at = &list->pixel[i];

        patched.disparity[pixel_at(s, at->x, at->y)] = at->disparity;
    }
    return patched;
}

/* Renders both ways; 0 when they agree to the bound. */
static int compare(struct scene *s, struct refocus_renderer *r, uint32_t method, int tests,
                   uint8_t *fixed, uint8_t *exact)
{
    struct refocus_settings params = refocus_settings_default((float)s->df, (float)s->K);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, fixed, s->width, s->height, 3 * s->width);
    double light[256], psnr;

    for (int c = 0; c < 256; c++)
        light[c] = to_light(c);
    params.render.method = method;
    params.search.iterations = tests;
    params.render.prefilter = 0;
    if (method == REFOCUS_METHOD_SWEEP)
        params.render.rays = 128; /* then all rows are computed: the others are the twin's part */
    params.render.sigma = INFINITY;
    if (refocus_render_settings(r, &params, &out))
        return 1;
    if (method == REFOCUS_METHOD_SWEEP) {
        struct scene patched = with_silhouettes(s, r);

        sweep_all(&patched, r, light, exact);
        free(patched.disparity);
    } else
        search_all(s, light, tests, exact);
    psnr = quality_psnr(quality_rmse(fixed, exact, s->width, s->height, 0, NULL, NULL));
    printf("%s %s, T = %d, df = %.3f, K = %g: fixed point to double precision %.2f dB\n",
           psnr >= bound_db ? "ok    " : "FAILED", refocus_method_name(method), tests, s->df, s->K,
           psnr);
    return psnr < bound_db;
}

int main(int argc, char **argv)
{
    static const double focus[] = {0.6886, 0.2573, 0};
    struct scene s = {0};
    struct refocus_renderer *r = NULL;
    uint8_t *fixed = NULL, *exact = NULL;
    char path[4096];
    int failed = 1, w, h;

    snprintf(path, sizeof path, "%s/allfocus.png", argc > 1 ? argv[1] : ".");
    if (!(s.photo = png_io_read(path, 3, &s.width, &s.height)))
        goto done;
    snprintf(path, sizeof path, "%s/disparity.png", argv[1]);
    if (!(s.disparity = png_io_read(path, 1, &w, &h)) || w != s.width || h != s.height)
        goto done;
    fixed = malloc(3 * (size_t)w * (size_t)h);
    exact = malloc(3 * (size_t)w * (size_t)h);
    const struct refocus_renderer_params limits = refocus_renderer_params_default(w, h, 20);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, s.photo, w, h, 3 * w);
    const struct refocus_disparity map = refocus_disparity16(s.disparity, w, h, 2 * w);
    if (!fixed || !exact || refocus_renderer_create(&r, &limits) ||
        refocus_prepare(r, &photo, &map))
        goto done;
    failed = 0;
    for (int i = 0; i < 3; i++) {
        s.K = 20;
        s.df = focus[i];
        failed |= compare(&s, r, REFOCUS_METHOD_SEARCH, 1, fixed, exact);
        failed |= compare(&s, r, REFOCUS_METHOD_SEARCH, 2, fixed, exact);
        failed |= compare(&s, r, REFOCUS_METHOD_SWEEP, 1, fixed, exact);
    }
done:
    refocus_renderer_destroy(&r);
    free(s.photo);
    free(s.disparity);
    free(fixed);
    free(exact);
    return failed;
}
