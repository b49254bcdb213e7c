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
#include <string.h>

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

/* A pixel that a ray passes, and the disparities there that it meets. The same for every p,
 * so a ray's steps are worked out once for a tile. */
struct step {
    int dx, dy;    /* q - p */
    int low, high; /* disparities that satisfy eq. 4 to half a pixel, 65535 = 1 */
};
enum { MAX_STEPS = REFOCUS_MAX_BLUR_RADIUS + 3 };

/* Steps of a ray from the near end; their number. */
static int make_steps(const struct rf_frame *f, double u, double v, struct step step[MAX_STEPS])
{
    const double length = sqrt(u * u + v * v);
    const double K = f->params->max_blur_radius, df = f->params->focus_disparity;
    const bool steep = fabs(v) > fabs(u);
    const double major = steep ? v : u, minor = steep ? u : v;
    int from, to, direction, count = 0;

    if (length * K < 1e-9) { /* the centre ray meets its own pixel */
        step[0] = (struct step){0, 0, 0, 65535};
        return 1;
    }
    from = (int)floor(major * K * (df - 1) + 0.5);
    to = (int)floor(major * K * df + 0.5);
    direction = to >= from ? 1 : -1;
    for (int k = from; k != to + direction; k += direction) {
        const int other = (int)floor(k * minor / major + 0.5);
        const double along = k / major * length; /* l_pq */
        /* | along - length K (df - d) | <= 1/2, solved for d */
        const double middle = df - along / (length * K), half = 0.5 / (length * K);
        const double low = fmax(0, ceil(65535 * (middle - half)));
        const double high = fmin(65535, floor(65535 * (middle + half)));

        if (low <= high)
            step[count++] = (struct step){steep ? other : k, steep ? k : other, (int)low,
                                          (int)high};
    }
    return count;
}

static const uint16_t *disparity_at(const struct refocus_renderer *r, int x, int y)
{
    return r->disparity + y * r->stride + x;
}

/* The front-most hit of a ray of pixel (x, y); false: it meets nothing. */
static bool trace(const struct refocus_renderer *r, int x, int y, const struct step *step,
                  int count, int *qx, int *qy)
{
    for (int i = 0; i < count; i++) {
        *qx = clamp(x + step[i].dx, r->width - 1);
        *qy = clamp(y + step[i].dy, r->height - 1);
        const int d = *disparity_at(r, *qx, *qy);
        if (d >= step[i].low && d <= step[i].high)
            return true;
    }
    return false;
}

/* The pixel that stands for one hidden from ray (u, v). */
static void mirror(const struct rf_frame *f, int x, int y, double u, double v, int *qx, int *qy)
{
    const double d = *disparity_at(f->r, x, y) / 65535.0;
    const double s = f->params->max_blur_radius * (f->params->focus_disparity - d);

    *qx = clamp((int)floor(x - u * s + 0.5), f->r->width - 1);
    *qy = clamp((int)floor(y - v * s + 0.5), f->r->height - 1);
}

/* Sums of eq. 5 over the rays of a pixel. */
struct exact_sums {
    double light[3], weight;
};

static void add(const struct rf_frame *f, int qx, int qy, double share, struct exact_sums *sums)
{
    const struct refocus_renderer *r = f->r;
    const uint8_t *to_code = r->transfer[r->blend].to_code;
    const ptrdiff_t at = qy * r->stride + qx;
    int code[3], most = 0;
    double w;

    for (int c = 0; c < 3; c++) {
        code[c] = to_code[4 * r->front.light[c][at]];
        most = code[c] > most ? code[c] : most;
    }
    w = f->exact->weight[most] * share;
    sums->weight += w;
    for (int c = 0; c < 3; c++)
        sums->light[c] += w * f->exact->light[code[c]];
}

static void trace_tile(const struct rf_frame *f, struct rf_rect rect,
                       struct exact_sums sums[RF_TILE][RF_TILE])
{
    const struct rf_ray_set *set = &f->r->set[f->r->preset];
    const double K = f->params->max_blur_radius;

    for (int n = 0; n < set->count; n++) {
        double u = set->ray[n].u / 32768.0, v = set->ray[n].v / 32768.0;
        struct step step[MAX_STEPS];
        int count;

        if (f->params->rays == REFOCUS_RAYS_FULL && K > 0) { /* Q15 back to mask pixels */
            u = fmax(-1, fmin(1, floor(u * K + 0.5) / K));
            v = fmax(-1, fmin(1, floor(v * K + 0.5) / K));
        }
        count = make_steps(f, u, v, step);
        for (int y = rect.y0; y < rect.y1; y++) {
            for (int x = rect.x0; x < rect.x1; x++) {
                int qx, qy;

                if (!trace(f->r, x, y, step, count, &qx, &qy))
                    mirror(f, x, y, u, v, &qx, &qy);
                add(f, qx, qy, set->ray[n].weight, &sums[y - rect.y0][x - rect.x0]);
            }
        }
    }
}

void rf_raytrace_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct exact_sums sums[RF_TILE][RF_TILE];

    (void)tx;
    (void)ty;
    (void)worker;
    memset(sums, 0, sizeof sums);
    trace_tile(f, rect, sums);
    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            const struct exact_sums *of = &sums[y - rect.y0][x - rect.x0];
            uint8_t rgb[3];

            for (int c = 0; c < 3; c++)
                rgb[c] = encode(f->exact, of->light[c] / of->weight);
            rf_write_pixel(f, x, y, rgb);
        }
    }
}
