/* raytrace.c: full image-space ray tracing, Yang et al. 2016, in double precision.
 *
 * The oracle of the other methods: nothing is guessed, rounded or shared. The part of a ray
 * that lies between the nearest and the farthest plane covers, in the picture, the
 * segment from p + u K (df - 1) to p + u K df. Its pixels are tried from the near end;
 * the first q that satisfies eq. 4 to half a pixel,
 *
 *     | l_pq - |u| K (df - d_q) | <= 1/2,
 *
 * is what the ray sees. A ray that meets nothing is hidden: the surface of p is taken to be
 * symmetric about p, so the hidden pixel at l = |u| K (df - d_p) is replaced by the one at -l.
 * Averages by eq. 5 over the exact curve of the blend.
 */
#include "methods/method.h"

#include <math.h>

static double curve(uint32_t blend, double x)
{
    if (blend == REFOCUS_BLEND_STORED)
        return x;
    if (blend == REFOCUS_BLEND_GAMMA)
        return pow(x, 2.2);
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

void rf_exact_init(struct rf_exact *exact, uint32_t blend, double sigma)
{
    for (int c = 0; c < 256; c++) {
        const double below = (255 - c) / sigma;

        exact->light[c] = curve(blend, c / 255.0);
        exact->boundary[c] = curve(blend, (c + 0.5) / 255);
        exact->weight[c] = exp(-below * below / 2);
    }
}

static uint8_t encode(const struct rf_exact *exact, double light)
{
    int low = 0, high = 255; /* the code is between them */

    while (low < high) {
        const int middle = (low + high) / 2;

        if (light < exact->boundary[middle])
            high = middle;
        else
            low = middle + 1;
    }
    return (uint8_t)low;
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* The front-most hit of a ray of pixel (x, y); false: it meets nothing. */
static bool trace(const struct rf_frame *f, int x, int y, double u, double v, int *qx, int *qy)
{
    const struct refocus_renderer *r = f->r;
    const double length = sqrt(u * u + v * v);
    const double K = f->params->max_blur_radius, df = f->params->focus_disparity;
    const bool steep = fabs(v) > fabs(u);
    const double major = steep ? v : u, minor = steep ? u : v;
    double from, to;
    int step, last;

    if (length * K < 1e-9) { /* the centre ray meets its own pixel */
        *qx = x;
        *qy = y;
        return true;
    }
    from = floor(major * K * (df - 1) + 0.5);
    to = floor(major * K * df + 0.5);
    step = to >= from ? 1 : -1;
    last = (int)to + step;
    for (int k = (int)from; k != last; k += step) {
        const int other = (int)floor(k * minor / major + 0.5);
        const double along = k / major * length; /* l_pq */
        double d;

        *qx = clamp(x + (steep ? other : k), r->width - 1);
        *qy = clamp(y + (steep ? k : other), r->height - 1);
        d = r->disparity[(size_t)*qy * r->width + *qx] / 65535.0;
        if (fabs(along - length * K * (df - d)) <= 0.5)
            return true;
    }
    return false;
}

/* The pixel that stands for one hidden from ray (u, v). */
static void mirror(const struct rf_frame *f, int x, int y, double u, double v, int *qx, int *qy)
{
    const double d = f->r->disparity[(size_t)y * f->r->width + x] / 65535.0;
    const double s = f->params->max_blur_radius * (f->params->focus_disparity - d);

    *qx = clamp((int)floor(x - u * s + 0.5), f->r->width - 1);
    *qy = clamp((int)floor(y - v * s + 0.5), f->r->height - 1);
}

static void trace_pixel(const struct rf_frame *f, const struct rf_ray_set *set, int x, int y,
                        uint8_t rgb[3])
{
    const struct refocus_renderer *r = f->r;
    const uint8_t *to_code = r->transfer[r->blend].to_code;
    const double K = f->params->max_blur_radius;
    double sum[3] = {0, 0, 0}, weight = 0;

    for (int n = 0; n < set->count; n++) {
        double u = set->ray[n].u / 32768.0, v = set->ray[n].v / 32768.0, w;
        int qx, qy, code[3], most = 0;
        ptrdiff_t at;

        if (f->params->rays == REFOCUS_RAYS_FULL && K > 0) { /* Q15 back to mask pixels */
            u = fmax(-1, fmin(1, floor(u * K + 0.5) / K));
            v = fmax(-1, fmin(1, floor(v * K + 0.5) / K));
        }
        if (!trace(f, x, y, u, v, &qx, &qy))
            mirror(f, x, y, u, v, &qx, &qy);
        at = qy * r->stride + qx;
        for (int c = 0; c < 3; c++) {
            code[c] = to_code[4 * r->front.light[c][at]];
            most = code[c] > most ? code[c] : most;
        }
        w = f->exact->weight[most] * set->ray[n].weight;
        weight += w;
        for (int c = 0; c < 3; c++)
            sum[c] += w * f->exact->light[code[c]];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = encode(f->exact, sum[c] / weight);
}

void rf_raytrace_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct rf_ray_set *set = &f->r->set[f->r->sets - 1];

    (void)tx;
    (void)ty;
    (void)worker;
    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            uint8_t rgb[3];

            trace_pixel(f, set, x, y, rgb);
            rf_write_pixel(f, x, y, rgb);
        }
    }
}
