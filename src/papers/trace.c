/* trace.c: follows rays through the picture to the surfaces that they hit.
 *
 * The part of a ray between the nearest and the farthest plane covers, in the picture, the
 * segment from p + u K (df - 1) to p + u K df. Its pixels are tried from the near end; the
 * first q that satisfies eq. 4 of Yang et al. 2016 to half a pixel,
 *
 *     | l_pq - |u| K (df - d_q) | <= 1/2,
 *
 * is the one that the ray sees. For one ray and one l_pq those are the d_q of an interval, the same
 * for every pixel p. A ray that hits nothing is hidden: the surface of p is assumed to be
 * symmetric about p, so the hidden pixel at l = |u| K (df - d_p) is replaced by the one at -l.
 */
#include "papers/papers.h"
#include "papers/trace.h"
#include "support/compare.h"

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

/* Rounds half up; |x| < 2^30. */
static int nearest(double x)
{
    const int whole = (int)(x + 0.5);

    return whole - (whole > x + 0.5);
}

/* Finds the disparities that satisfy eq. 4 at distance `along`: low to low + width. Returns false
 * if there are none. */
static bool hit_range(double along, double reach, double df, struct rf_step *step)
{
    const double least = (df - (along + 0.5) / reach) * 65535;
    const double most = (df - (along - 0.5) / reach) * 65535;
    int low = 0, high = 65535;

    if (least > 65535 || most < 0)
        return false;
    if (least > 0) /* rounded up */
        low = (int)least + (least > (int)least);
    if (most < 65535)
        high = (int)most;
    step->low = (uint16_t)low;
    step->width = (uint16_t)(high - low);
    return low <= high;
}

struct rf_blur_range rf_blur_range_of(const struct rf_frame *f, int tx, int ty)
{
    const int tiles = (f->view->pad + RF_TILE - 1) / RF_TILE;
    int least = INT16_MAX, most = INT16_MIN;

    for (int j = ty - tiles; j <= ty + tiles; j++) {
        for (int i = tx - tiles; i <= tx + tiles; i++) {
            const struct rf_bins *bins;

            if (i < 0 || j < 0 || i >= f->view->tiles_x || j >= f->view->tiles_y)
                continue;
            bins = &f->bins[(size_t)j * f->view->tiles_x + i];
            least = bins->least < least ? bins->least : least;
            most = bins->most > most ? bins->most : most;
        }
    }
    return (struct rf_blur_range){least / 256.0, most / 256.0};
}

void rf_path_of(const struct rf_frame *f, struct rf_blur_range reach, double u, double v,
                struct rf_path *path)
{
    const double margin = 0.6; /* half a pixel, and blurs are known to 1.25 / 256 */
    const double length = sqrt(u * u + v * v);
    const double K = f->params->max_blur_radius, df = f->params->focus_disparity;
    const bool steep = fabs(v) > fabs(u);
    const double major = steep ? v : u, minor = steep ? u : v;
    const double a = fmax(reach.least, K * (df - 1)), b = fmin(reach.most, K * df);
    const double first = major * a, last = major * b;
    const int direction = major >= 0 ? 1 : -1;
    const int whole_from = (int)floor(major * K * (df - 1) + 0.5);
    const int whole_to = (int)floor(major * K * df + 0.5);
    int from = (int)floor(first - direction * margin + 0.5);
    int to = (int)floor(last + direction * margin + 0.5);

    path->u = u;
    path->v = v;
    path->steps = 0;
    path->central = length * K < 1e-9;
    if (path->central)
        return;
    if ((from - whole_from) * direction < 0)
        from = whole_from;
    if ((to - whole_to) * direction > 0)
        to = whole_to;
    for (int k = from; (to - k) * direction >= 0; k += direction) {
        const int other = nearest(k * minor / major);
        struct rf_step *step = &path->step[path->steps];

        step->dx = (int16_t)(steep ? other : k);
        step->dy = (int16_t)(steep ? k : other);
        step->offset = (ptrdiff_t)step->dy * f->view->stride + step->dx;
        path->steps += hit_range(k / major * length, length * K, df, step);
    }
}

/* Finds the front-most hit of the ray of pixel (x, y); returns false if it hits nothing. */
static bool trace(const struct rf_frame *f, const struct rf_path *path, int x, int y, int *qx,
                  int *qy)
{
    const uint16_t *p = f->disparity.at + y * f->view->stride + x;
    const bool inside = x >= f->view->pad && y >= f->view->pad &&
                        x < f->view->width - f->view->pad && y < f->view->height - f->view->pad;

    for (int i = 0; i < path->steps; i++) {
        const struct rf_step *step = &path->step[i];
        const int tx = inside ? x + step->dx : rf_clamp(x + step->dx, 0, f->view->width - 1);
        const int ty = inside ? y + step->dy : rf_clamp(y + step->dy, 0, f->view->height - 1);
        const uint16_t d = inside ? p[step->offset] : f->disparity.at[ty * f->view->stride + tx];

        if ((uint16_t)(d - step->low) <= step->width) {
            *qx = tx;
            *qy = ty;
            return true;
        }
    }
    return false;
}

/* Finds the pixel that stands for the one that is hidden from the ray. */
static void mirror(const struct rf_frame *f, const struct rf_path *path, int x, int y, int *qx,
                   int *qy)
{
    const double d = f->disparity.at[y * f->view->stride + x] / 65535.0;
    const double s = f->params->max_blur_radius * (f->params->focus_disparity - d);

    *qx = rf_clamp((int)floor(x - path->u * s + 0.5), 0, f->view->width - 1);
    *qy = rf_clamp((int)floor(y - path->v * s + 0.5), 0, f->view->height - 1);
}

void rf_path_add(const struct rf_frame *f, const struct rf_path *path, int x, int y, double weight,
                 struct rf_exact_sums *sums)
{
    const uint8_t *to_code = f->transfer->to_code;
    const int i = y % RF_TILE * RF_TILE + x % RF_TILE;
    int qx = x, qy = y, code[3], most = 0;
    ptrdiff_t at;

    if (!path->central && !trace(f, path, x, y, &qx, &qy))
        mirror(f, path, x, y, &qx, &qy);
    at = qy * f->view->stride + qx;
    for (int c = 0; c < 3; c++) {
        code[c] = to_code[4 * f->light.channel[c][at]];
        most = code[c] > most ? code[c] : most;
    }
    weight *= f->exact->weight[most];
    sums->weight[i] += weight;
    for (int c = 0; c < 3; c++)
        sums->light[i][c] += weight * f->exact->light[code[c]];
}

void rf_exact_write(const struct rf_frame *f, struct rf_rect rect, const struct rf_exact_sums *sums)
{
    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            const int i = y % RF_TILE * RF_TILE + x % RF_TILE;
            uint8_t rgb[3];

            for (int c = 0; c < 3; c++)
                rgb[c] = encode(f->exact, sums->light[i][c] / sums->weight[i]);
            rf_write_pixel(f, x, y, rgb);
        }
    }
}
