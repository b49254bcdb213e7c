/* twin.c: makes a twin in double precision: its blur, its pre-filtered light, its rays and means.
 */
#include "twin.h"

double twin_to_light(uint32_t blend, double code)
{
    const double x = code / 255;

    if (blend == REFOCUS_BLEND_STORED)
        return x;
    if (blend == REFOCUS_BLEND_GAMMA)
        return pow(x, 2.2);
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

double twin_to_code(uint32_t blend, double light)
{
    if (blend == REFOCUS_BLEND_STORED)
        return 255 * light;
    if (blend == REFOCUS_BLEND_GAMMA)
        return 255 * pow(light, 1 / 2.2);
    return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055);
}

static double *plane(const struct twin *t)
{
    double *p = malloc((size_t)t->width * (size_t)t->height * sizeof *p);

    assert_non_null(p);
    return p;
}

static double blur_of(const struct twin *t, int disparity)
{
    return t->K * (t->df - disparity / 65535.0);
}

void twin_create(struct twin *t, const struct picture *p, const struct refocus_settings *params,
                 const struct twin_silhouette *silhouette, int silhouettes)
{
    *t = (struct twin){p->width,
                       p->height,
                       params,
                       (double)params->render.max_blur_radius,
                       (double)params->render.focus_disparity,
                       1,
                       p->disparity,
                       silhouette,
                       silhouettes,
                       {0},
                       {0},
                       {0},
                       0,
                       0,
                       0};
    for (double most = 127; t->K > most; most = 118 * t->unit)
        t->unit *= 2;
    t->map_blur = plane(t);
    t->blur = plane(t);
    t->background_blur = plane(t);
    for (int c = 0; c < 3; c++) {
        t->light[c] = plane(t);
        t->smooth[c] = plane(t);
        t->background[c] = plane(t);
        for (int i = 0; i < t->width * t->height; i++)
            t->light[c][i] = t->smooth[c][i] =
                twin_to_light(params->render.blend, p->rgb[3 * i + c]);
    }
    for (int i = 0; i < t->width * t->height; i++)
        t->map_blur[i] = t->blur[i] = blur_of(t, p->disparity[i]);
    for (int i = 0; i < silhouettes; i++)
        t->blur[silhouette[i].y * t->width + silhouette[i].x] = blur_of(t, silhouette[i].disparity);
}

void twin_destroy(struct twin *t)
{
    free(t->map_blur);
    free(t->blur);
    free(t->background_blur);
    for (int c = 0; c < 3; c++) {
        free(t->light[c]);
        free(t->smooth[c]);
        free(t->background[c]);
    }
}

/* Along one axis: a third of the way from a pixel to each of those neighbours, `step` pixels away,
 * whose blur is within an eighth, one unit to two, of its own; the pixel itself where it is
 * blurred by `above` or less, and, of at most 64 rays, a part of both up to 5/4
 * of that. */
static void smooth(const struct twin *t, double *out, const double *in, int step_x, int step_y,
                   double above)
{
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++) {
            const int p = y * t->width + x;
            const double size = fabs(t->blur[p]);
            const double part = fmin(fmax(4 * (size / above - 1), 0), 1);
            double way = 0;

            for (int i = -1; i <= 1; i++) {
                const int q = twin_at(t, x + i * step_x, y + i * step_y);

                if (fabs(t->blur[q] - t->blur[p]) <= fmin(fmax(size / 8, t->unit), 2 * t->unit))
                    way += in[q] - in[p];
            }
            out[p] = in[p] + way / 3 * (t->params->render.rays > 64 ? size > above : part);
        }
    }
}

/* Steps of 1, 2 and 4 pixels from where rays lie 1.5, 3 and 6 pixels apart, and so on to 16 where
 * blurs may exceed 54 pixels and to 64 where they may exceed 127; two more each if that can be at
 * all. */
void twin_prefilter(struct twin *t)
{
    const double apart = sqrt(t->params->render.rays / 3.14159265358979);
    const float K = t->params->render.max_blur_radius;
    const int most = K > 127 ? 64 : K > 54 ? 16 : 4;
    double *between;
    int last = 1;

    if (!t->params->render.prefilter || t->params->render.rays == REFOCUS_RAYS_FULL)
        return;
    between = plane(t);
    while (last < most && t->K > 3 * last * apart)
        last *= 4;
    for (int step = 1; step <= last; step *= 2) {
        for (int c = 0; c < 3; c++) {
            smooth(t, between, t->smooth[c], 0, step, 1.5 * step * apart);
            smooth(t, t->smooth[c], between, step, 0, 1.5 * step * apart);
        }
    }
    free(between);
}

void twin_add(const struct twin *t, struct twin_sum *sum, double *const light[3], int at,
              double share)
{
    const double most = fmax(light[0][at], fmax(light[1][at], light[2][at]));
    const double below =
        (255 - twin_to_code(t->params->render.blend, most)) / (double)t->params->render.sigma;
    const double w = share * exp(-below * below / 2);

    sum->weight += w;
    for (int c = 0; c < 3; c++)
        sum->light[c] += w * light[c][at];
}

void twin_encode(const struct twin *t, const struct twin_sum *sum, uint8_t rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)floor(twin_to_code(t->params->render.blend, sum->light[c] / sum->weight) +
                                0.5);
}

struct refocus_ray *twin_rays(const struct refocus_aperture *aperture, int rays, double K,
                              int *count)
{
    struct refocus_ray *ray;

    *count = rays == REFOCUS_RAYS_FULL ? refocus_aperture_full_rays(aperture, K, 0, NULL) : rays;
    ray = calloc((size_t)*count, sizeof *ray);
    assert_non_null(ray);
    if (rays == REFOCUS_RAYS_FULL)
        assert_int_equal(refocus_aperture_full_rays(aperture, K, *count, ray), *count);
    else
        assert_int_equal(refocus_aperture_rays(aperture, rays, ray), REFOCUS_OK);
    return ray;
}
