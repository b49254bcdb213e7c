/* rays.c: ray samples of an aperture: so many of equal share, or one for each pixel of its mask.
 *
 * In every case (u, v) is minus the place on the mask as it is drawn; see refocus/aperture.h.
 */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>

static int16_t to_q15(double x)
{
    const double q = floor(x * 32768 + 0.5);

    return (int16_t)(q > 32767 ? 32767 : q < -32767 ? -32767 : q);
}

struct refocus_ray rf_squeezed_ray(const struct refocus_aperture *a, double x, double y)
{
    return (struct refocus_ray){to_q15(-x * a->squeeze_x), to_q15(-y * a->squeeze_y), 255};
}

struct refocus_ray rf_shape_ray(double x, double y, int weight)
{
    return (struct refocus_ray){to_q15(-x), to_q15(-y), (uint16_t)weight};
}

void rf_spiral(int n, int count, double *radius, double *turns)
{
    const double golden = 0.38196601125010515; /* 1 - 1 / phi */
    const double t = n * golden;

    *radius = sqrt((n + 0.5) / count);
    *turns = t - floor(t);
}

int rf_aperture_rays(const struct refocus_aperture *aperture, int count, bool before,
                     struct refocus_ray *rays, struct rf_run *run)
{
    if (!aperture)
        aperture = &rf_disc;
    if (!rays || count < 1 || count > REFOCUS_MAX_RAYS)
        return REFOCUS_ERR_ARGUMENT;
    aperture->shape->rays(aperture, count, before, rays, run);
    return REFOCUS_OK;
}

int refocus_aperture_rays(const struct refocus_aperture *aperture, int count,
                          struct refocus_ray *rays)
{
    return rf_aperture_rays(aperture, count, false, rays, NULL);
}

/* The open share of mask pixel (x, y) at radius K, 0 to 255, by 8 x 8 points. */
static int coverage(const struct refocus_aperture *a, double radius, int x, int y)
{
    int sum = 0;

    for (int j = 0; j < 8; j++)
        for (int i = 0; i < 8; i++)
            sum += rf_aperture_open(a, (x + (2 * i - 7) / 16.0) / radius,
                                    (y + (2 * j - 7) / 16.0) / radius);
    return (sum + 32) / 64;
}

int rf_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                          int capacity, struct refocus_ray *rays, struct rf_run *run)
{
    int count = 0, most = 0;

    if (!aperture)
        aperture = &rf_disc;
    if (!(max_blur_radius > 0 && max_blur_radius <= 127) || capacity < 0 || (capacity > 0 && !rays))
        return REFOCUS_ERR_ARGUMENT;
    most = (int)ceil(max_blur_radius);
    for (int open = 1; open >= 0; open--) { /* open pixels, then half open ones */
        for (int y = -most; y <= most && !rf_run_cancelled(run); y++) {
            for (int x = -most; x <= most; x++) {
                const int weight = coverage(aperture, max_blur_radius, x, y);

                if (weight == 0 || (weight == 255) != open)
                    continue;
                if (count < capacity)
                    rays[count] = rf_shape_ray(x / max_blur_radius, y / max_blur_radius, weight);
                count++;
            }
        }
    }
    if (count == 0) { /* the mask is smaller than any pixel: use its centre */
        if (capacity > 0)
            rays[0] = rf_shape_ray(0, 0, 255);
        count = 1;
    }
    return count;
}

int refocus_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                               int capacity, struct refocus_ray *rays)
{
    return rf_aperture_full_rays(aperture, max_blur_radius, capacity, rays, NULL);
}
