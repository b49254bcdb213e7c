/* twin_search.c: Yang et al. 2016's randomized intersection search in double precision; see
 * src/gather/search.c. */
#include "twin.h"

/* Adds what ray `ray` of (x, y) sees. */
static void trace(const struct twin *t, int x, int y, struct refocus_ray ray, const double *blur,
                  struct twin_sum *sum)
{
    const double length = hypot(ray.u, ray.v) / 32768;
    const int p = twin_at(t, x, y);
    double s = 0, found = blur[twin_hit(t, x, y, ray, t->K * (t->df - 1))];
    int q = p;
    bool valid = false;

    for (int i = 0; i < t->params->search.iterations && !valid; i++) {
        s = found;
        q = twin_hit(t, x, y, ray, s);
        found = blur[q];
        valid = length * fabs(found - s) <= 0.5;
    }
    if (valid || found <= blur[p]) {
        twin_add(t, sum, t->light, q, ray.weight);
    } else if (t->params->search.background) {
        twin_add(t, sum, t->background, twin_hit(t, x, y, ray, t->background_blur[p]), ray.weight);
    } else if (t->params->search.mirror) {
        ray.u = (int16_t)-ray.u;
        ray.v = (int16_t)-ray.v;
        twin_add(t, sum, t->light, twin_hit(t, x, y, ray, s), ray.weight);
    } else {
        twin_add(t, sum, t->light, p, ray.weight);
    }
}

void twin_search(struct twin *t, uint8_t *rgb)
{
    const double *blur = t->params->search.background ? t->blur : t->map_blur;
    int count;
    struct refocus_ray *ray =
        twin_rays(t->params->render.aperture, t->params->render.rays, t->K, &count);

    if (t->params->search.background) {
        twin_prefilter(t);
        twin_background(t);
    }
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++, rgb += 3) {
            struct twin_sum sum = {{0}, 0};

            for (int n = 0; n < count; n++)
                trace(t, x, y, ray[n], blur, &sum);
            twin_encode(t, &sum, rgb);
        }
    }
    free(ray);
}
