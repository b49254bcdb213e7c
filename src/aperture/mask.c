/* mask.c: apertures that are drawn as a greyscale picture. */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "image/format.h"

/* The mask at a place, before it is squeezed and its light is spread. */
static int mask_at(const struct refocus_aperture *a, double x, double y)
{
    const int side = a->width > a->height ? a->width : a->height;
    const double px = x * side / 2 + a->width / 2.0;
    const double py = y * side / 2 + a->height / 2.0;

    if (px < 0 || py < 0 || px >= a->width || py >= a->height)
        return 0;
    return a->tables->mask[(int)py * REFOCUS_MAX_APERTURE_SIDE + (int)px];
}

static int mask_open(const struct refocus_aperture *a, double x, double y)
{
    x /= a->squeeze_x;
    y /= a->squeeze_y;
    return rf_shape_light(a, mask_at(a, x, y), x * x + y * y);
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

/* The light of each cell of the reduced mask. */
struct cells {
    const uint8_t *reduced;
    const struct rf_profile *profile;
    bool plain; /* all of it lies in the hole: an even shape is better than none */
};

static int light_of(const struct cells *cells, int i)
{
    const double x = (2 * (i % RF_CURVE_SIDE) + 1.0) / RF_CURVE_SIDE - 1;
    const double y = (2 * (i / RF_CURVE_SIDE) + 1.0) / RF_CURVE_SIDE - 1;

    if (cells->plain || !cells->reduced[i])
        return cells->reduced[i];
    return (uint8_t)floor(cells->reduced[i] * rf_profile_density(cells->profile, x * x + y * y) +
                          0.5);
}

static int64_t total_of(const struct cells *cells)
{
    int64_t total = 0;

    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++)
        total += light_of(cells, i);
    return total;
}

/* Places lie in (u, v) of the rays to come, in 1/256 of a cell of the reduced mask. */
static_assert(256 * RF_CURVE_SIDE <= INT16_MAX, "a place fits a ray");
static_assert((uint64_t)255 * RF_CURVE_SIDE * RF_CURVE_SIDE * RF_CURVE_SIDE <= UINT32_MAX,
              "sums of all cells fit 32 bits");

/* Moves each place to the middle of the light that is nearest to it: one step of Lloyd's. */
static void relax(const struct cells *cells, int count, struct refocus_ray *place,
                  struct rf_run *run)
{
    uint32_t sum[REFOCUS_MAX_RAYS] = {0}; /* light; and times cells across and down */
    uint32_t sum_x[REFOCUS_MAX_RAYS] = {0}, sum_y[REFOCUS_MAX_RAYS] = {0};

    for (int y = 0; y < RF_CURVE_SIDE && !rf_run_cancelled(run); y++) {
        for (int x = 0; x < RF_CURVE_SIDE; x++) {
            const uint32_t weight = (uint32_t)light_of(cells, y * RF_CURVE_SIDE + x);
            const int32_t cx = 256 * x + 128, cy = 256 * y + 128;
            int32_t least = INT32_MAX;
            int nearest = 0;

            if (!weight)
                continue;
            for (int n = 0; n < count; n++) {
                const int32_t dx = place[n].u - cx, dy = place[n].v - cy;

                if (dx * dx + dy * dy < least) {
                    least = dx * dx + dy * dy;
                    nearest = n;
                }
            }
            sum[nearest] += weight;
            sum_x[nearest] += weight * (uint32_t)x;
            sum_y[nearest] += weight * (uint32_t)y;
        }
    }
    for (int n = 0; n < count; n++) {
        if (sum[n]) {
            place[n].u = (int16_t)((256 * (int64_t)sum_x[n] + 128 * (int64_t)sum[n]) / sum[n]);
            place[n].v = (int16_t)((256 * (int64_t)sum_y[n] + 128 * (int64_t)sum[n]) / sum[n]);
        }
    }
}

/* Spreads points at equal steps of light along a Hilbert curve, then relaxes them by a few steps.
 */
static void mask_rays(const struct refocus_aperture *a, int count, bool before,
                      struct refocus_ray *rays, struct rf_run *run)
{
    struct cells cells = {a->tables->reduced, before ? &a->before : &a->behind, false};
    int64_t total = total_of(&cells), passed = 0;
    int n = 0;

    cells.plain = total == 0;
    if (cells.plain)
        total = total_of(&cells);
    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++) {
        int x, y;

        hilbert(i, &x, &y);
        passed += light_of(&cells, y * RF_CURVE_SIDE + x);
        while (n < count && (2 * n + 1) * total <= 2 * count * passed)
            rays[n++] =
                (struct refocus_ray){(int16_t)(256 * x + 128), (int16_t)(256 * y + 128), 255};
    }
    for (int pass = 0; pass < 4; pass++)
        relax(&cells, count, rays, run);
    for (n = 0; n < count; n++)
        rays[n] = rf_squeezed_ray(a, rays[n].u / (128.0 * RF_CURVE_SIDE) - 1,
                                  rays[n].v / (128.0 * RF_CURVE_SIDE) - 1);
}

const struct rf_shape rf_shape_mask = {
    .open = mask_open,
    .rays = mask_rays,
    .is_fine = true,
    .fills_square = true,
};

/* Reduces the mask to a grid of RF_CURVE_SIDE^2 cells: each is the mean of 8 x 8 points. */
static void reduce(struct refocus_aperture *a)
{
    for (int j = 0; j < RF_CURVE_SIDE; j++) {
        for (int i = 0; i < RF_CURVE_SIDE; i++) {
            int sum = 0;

            for (int v = 0; v < 8; v++)
                for (int u = 0; u < 8; u++)
                    sum += mask_at(a, (2 * i + (2 * u + 1) / 8.0) / RF_CURVE_SIDE - 1,
                                   (2 * j + (2 * v + 1) / 8.0) / RF_CURVE_SIDE - 1);
            a->tables->reduced[j * RF_CURVE_SIDE + i] = (uint8_t)((sum + 32) / 64);
        }
    }
}

int refocus_aperture_create_mask(struct refocus_aperture **aperture, const uint8_t *mask, int width,
                                 int height, ptrdiff_t stride)
{
    struct refocus_aperture *a;
    int status, any = 0;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    if (!mask || width < 1 || height < 1 || width > REFOCUS_MAX_APERTURE_SIDE ||
        height > REFOCUS_MAX_APERTURE_SIDE || !rf_good_stride(stride, width, height))
        return REFOCUS_ERR_ARGUMENT;
    status = rf_shape_create(aperture, &rf_shape_mask);
    if (status)
        return status;
    a = *aperture;
    a->width = width;
    a->height = height;
    for (int y = 0; y < height; y++)
        memcpy(a->tables->mask + y * REFOCUS_MAX_APERTURE_SIDE, mask + y * stride, (size_t)width);
    reduce(a);
    for (int i = 0; i < RF_CURVE_SIDE * RF_CURVE_SIDE; i++)
        any |= a->tables->reduced[i];
    if (!any) {
        refocus_aperture_destroy(aperture);
        return REFOCUS_ERR_ARGUMENT;
    }
    a->id = rf_shape_hash(3, a->tables->mask, sizeof a->tables->mask);
    a->id = rf_shape_hash(a->id, &width, sizeof width);
    a->id = rf_shape_hash(a->id, &height, sizeof height);
    rf_summed_light_make(a);
    return REFOCUS_OK;
}
