/* rays.c: spreads ray samples evenly over the light of an aperture.
 *
 * Each of N rays stands for an equal share of the light. A disc takes Vogel's spiral: ray n at
 * radius sqrt((n + 1/2) / N) and n golden turns; for the sizes that tiles choose from, points of
 * that spiral that were moved so that their projections are even as well (tables/rays.py). A
 * polygon takes the spiral, its circles drawn onto the polygon so that equal areas stay equal; so
 * does any other outline, by its triangles, and where light is not spread evenly the radii are
 * those of equal light. A mask takes N points at equal steps of light along a Hilbert
 * curve over it, then a few steps of Lloyd's relaxation.
 *
 * In every case (u, v) is minus the place on the mask as it is drawn; see
 * refocus/aperture.h.
 */
#include "aperture/aperture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tables/rays.inc"

static int16_t to_q15(double x)
{
    const double q = floor(x * 32768 + 0.5);

    return (int16_t)(q > 32767 ? 32767 : q < -32767 ? -32767 : q);
}

static struct refocus_ray squeezed_ray(const struct refocus_aperture *a, double x, double y)
{
    return (struct refocus_ray){to_q15(-x * a->squeeze_x), to_q15(-y * a->squeeze_y), 255};
}

static struct refocus_ray make_ray(double x, double y, int weight)
{
    return (struct refocus_ray){to_q15(-x), to_q15(-y), (uint16_t)weight};
}

/* Ray n of N of the unit disc in polar form: radius and angle in turns. */
static void vogel(int n, int count, double *radius, double *turns)
{
    const double golden = 0.38196601125010515; /* 1 - 1 / phi */
    const double t = n * golden;

    *radius = sqrt((n + 0.5) / count);
    *turns = t - floor(t);
}

static void disc_rays(int count, struct refocus_ray *rays)
{
    for (size_t i = 0; i < sizeof disc_sets / sizeof disc_sets[0]; i++)
        if (disc_sets[i].count == count) {
            const int16_t(*const point)[2] = disc_points + disc_sets[i].first;

            for (int n = 0; n < count; n++)
                rays[n] = (struct refocus_ray){(int16_t)-point[n][0], (int16_t)-point[n][1], 255};
            return;
        }
    for (int n = 0; n < count; n++) {
        double r, t, s, c;

        vogel(n, count, &r, &t);
        rf_sincos_turns(t, &s, &c);
        rays[n] = make_ray(r * c, r * s, 255);
    }
}

static void polygon_rays(const struct refocus_aperture *a, int count, struct refocus_ray *rays)
{
    for (int n = 0; n < count; n++) {
        double r, t;
        int i, j;

        vogel(n, count, &r, &t);
        t *= a->blades; /* the triangle from the centre to edge i, and where along it */
        i = (int)t % a->blades;
        j = (i + 1) % a->blades;
        t -= floor(t);
        rays[n] = make_ray(r * (a->corner_x[i] * (1 - t) + a->corner_x[j] * t),
                           r * (a->corner_y[i] * (1 - t) + a->corner_y[j] * t), 255);
    }
}

static void outline_rays(const struct refocus_aperture *a, int count, bool before,
                         struct refocus_ray *rays)
{
    const struct rf_profile *profile = before ? &a->before : &a->behind;

    for (int n = 0; n < count; n++) {
        double r, t, x, y;

        vogel(n, count, &r, &t);
        r = sqrt(rf_profile_square(profile, (n + 0.5) / count));
        rf_outline_at(a, t, &x, &y);
        rays[n] = squeezed_ray(a, r * x, -r * y);
    }
}

/* Finds cell number `at` along a Hilbert curve through RF_CURVE_SIDE^2 cells. */
static void hilbert(int at, int *x, int *y)
{
    *x = *y = 0;
    for (int side = 1; side < RF_CURVE_SIDE; side *= 2, at /= 4) {
        const int rx = 1 & (at / 2), ry = 1 & (at ^ rx);

        if (ry == 0) {
            const int old = *x;

            if (rx == 1) {
                *x = side - 1 - *x;
                *y = side - 1 - *y;
                *x ^= *y; /* swap */
                *y ^= *x;
                *x ^= *y;
            } else {
                *x = *y;
                *y = old;
            }
        }
        *x += side * rx;
        *y += side * ry;
    }
}

/* A place, in 1/256 of a cell of the reduced mask. */
struct place {
    int32_t x, y;
};

/* Moves each place to the middle of the light that is nearest to it: one step of Lloyd's. */
static void relax(const uint8_t *cell, int count, struct place *place, struct rf_run *run)
{
    int64_t sum_x[REFOCUS_MAX_RAYS] = {0}, sum_y[REFOCUS_MAX_RAYS] = {0};
    int64_t sum[REFOCUS_MAX_RAYS] = {0};

    for (int y = 0; y < RF_CURVE_SIDE && !rf_run_cancelled(run); y++) {
        for (int x = 0; x < RF_CURVE_SIDE; x++) {
            const int weight = cell[y * RF_CURVE_SIDE + x];
            const int32_t cx = 256 * x + 128, cy = 256 * y + 128;
            int64_t least = INT64_MAX;
            int nearest = 0;

            if (!weight)
                continue;
            for (int n = 0; n < count; n++) {
                const int64_t dx = place[n].x - cx, dy = place[n].y - cy;

                if (dx * dx + dy * dy < least) {
                    least = dx * dx + dy * dy;
                    nearest = n;
                }
            }
            sum[nearest] += weight;
            sum_x[nearest] += (int64_t)weight * cx;
            sum_y[nearest] += (int64_t)weight * cy;
        }
    }
    for (int n = 0; n < count; n++) {
        if (sum[n]) {
            place[n].x = (int32_t)(sum_x[n] / sum[n]);
            place[n].y = (int32_t)(sum_y[n] / sum[n]);
        }
    }
}

/* Computes the light of each cell of the reduced mask. */
static void weigh_cells(const struct refocus_aperture *a, bool before,
                        uint8_t cell[RF_CURVE_SIDE * RF_CURVE_SIDE])
{
    const struct rf_profile *profile = before ? &a->before : &a->behind;
    bool any = false;

    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++) {
        const double x = (2 * (i % RF_CURVE_SIDE) + 1.0) / RF_CURVE_SIDE - 1;
        const double y = (2 * (i / RF_CURVE_SIDE) + 1.0) / RF_CURVE_SIDE - 1;
        const double density = rf_profile_density(profile, x * x + y * y);

        cell[i] = (uint8_t)floor(a->reduced[i] * density + 0.5);
        any = any || cell[i];
    }
    if (!any) /* all of it lies in the hole: an even shape is better than none */
        memcpy(cell, a->reduced, RF_CURVE_SIDE * RF_CURVE_SIDE);
}

static void mask_rays(const struct refocus_aperture *a, int count, bool before,
                      struct refocus_ray *rays, struct rf_run *run)
{
    struct place place[REFOCUS_MAX_RAYS];
    uint8_t cell[RF_CURVE_SIDE * RF_CURVE_SIDE];
    int64_t total = 0, passed = 0;
    int n = 0;

    weigh_cells(a, before, cell);
    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++)
        total += cell[i];
    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++) {
        int x, y;

        hilbert(i, &x, &y);
        passed += cell[y * RF_CURVE_SIDE + x];
        while (n < count && (2 * n + 1) * total <= 2 * count * passed)
            place[n++] = (struct place){256 * x + 128, 256 * y + 128};
    }
    for (int pass = 0; pass < 4; pass++)
        relax(cell, count, place, run);
    for (n = 0; n < count; n++)
        rays[n] = squeezed_ray(a, place[n].x / (128.0 * RF_CURVE_SIDE) - 1,
                               place[n].y / (128.0 * RF_CURVE_SIDE) - 1);
}

int rf_aperture_rays(const struct refocus_aperture *aperture, int count, bool before,
                     struct refocus_ray *rays, struct rf_run *run)
{
    if (!aperture)
        aperture = &rf_disc;
    if (!rays || count < 1 || count > REFOCUS_MAX_RAYS)
        return REFOCUS_ERR_ARGUMENT;
    switch (aperture->shape) {
    case RF_SHAPE_DISC:
        disc_rays(count, rays);
        break;
    case RF_SHAPE_POLYGON:
        polygon_rays(aperture, count, rays);
        break;
    case RF_SHAPE_MASK:
        mask_rays(aperture, count, before, rays, run);
        break;
    case RF_SHAPE_OUTLINE:
        outline_rays(aperture, count, before, rays);
        break;
    }
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
                    rays[count] = make_ray(x / max_blur_radius, y / max_blur_radius, weight);
                count++;
            }
        }
    }
    if (count == 0) { /* the mask is smaller than any pixel: use its centre */
        if (capacity > 0)
            rays[0] = make_ray(0, 0, 255);
        count = 1;
    }
    return count;
}

int refocus_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                               int capacity, struct refocus_ray *rays)
{
    return rf_aperture_full_rays(aperture, max_blur_radius, capacity, rays, NULL);
}
