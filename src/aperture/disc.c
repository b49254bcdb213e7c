/* disc.c: the round aperture, whose rays are points of a spiral. */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>

#include "tables/rays.inc"

static int disc_open(const struct refocus_aperture *a, double x, double y)
{
    (void)a;
    return x * x + y * y <= 1 ? 255 : 0;
}

/* Uses Vogel's spiral, and for the sizes that tiles choose from points of that spiral that were
 * moved so that their projections are even as well (tables/rays.py). */
static void disc_rays(const struct refocus_aperture *a, int count, bool before,
                      struct refocus_ray *rays, struct rf_run *run)
{
    (void)a;
    (void)before;
    (void)run;
    for (size_t i = 0; i < sizeof disc_sets / sizeof disc_sets[0]; i++)
        if (disc_sets[i].count == count) {
            const int16_t(*const point)[2] = disc_points + disc_sets[i].first;

            for (int n = 0; n < count; n++)
                rays[n] = (struct refocus_ray){(int16_t)-point[n][0], (int16_t)-point[n][1], 255};
            return;
        }
    for (int n = 0; n < count; n++) {
        double r, t, s, c;

        rf_spiral(n, count, &r, &t);
        rf_sincos_turns(t, &s, &c);
        rays[n] = rf_shape_ray(r * c, r * s, 255);
    }
}

const struct rf_shape rf_shape_disc = {.open = disc_open, .rays = disc_rays};

const struct refocus_aperture rf_disc = {
    .id = 1, .shape = &rf_shape_disc, .squeeze_x = 1, .squeeze_y = 1};

int refocus_aperture_create_disc(struct refocus_aperture **aperture)
{
    return aperture ? rf_shape_create(aperture, &rf_shape_disc) : REFOCUS_ERR_ARGUMENT;
}
