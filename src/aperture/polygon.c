/* polygon.c: apertures that are regular polygons. */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>

static int polygon_open(const struct refocus_aperture *a, double x, double y)
{
    for (int i = 0; i < a->blades; i++) {
        const int j = (i + 1) % a->blades;
        const double ex = a->corner_x[j] - a->corner_x[i];
        const double ey = a->corner_y[j] - a->corner_y[i];

        /* Corners run counter-clockwise as seen, so with y down the inside is where
         * the cross product is not positive. */
        if (ex * (y - a->corner_y[i]) - ey * (x - a->corner_x[i]) > 0)
            return 0;
    }
    return 255;
}

/* Draws the circles of the spiral onto the polygon so that equal areas stay equal. */
static void polygon_rays(const struct refocus_aperture *a, int count, bool before,
                         struct refocus_ray *rays, struct rf_run *run)
{
    (void)before;
    (void)run;
    for (int n = 0; n < count; n++) {
        double r, t;
        int i, j;

        rf_spiral(n, count, &r, &t);
        t *= a->blades; /* the triangle from the centre to edge i, and where along it */
        i = (int)t % a->blades;
        j = (i + 1) % a->blades;
        t -= floor(t);
        rays[n] = rf_shape_ray(r * (a->corner_x[i] * (1 - t) + a->corner_x[j] * t),
                               r * (a->corner_y[i] * (1 - t) + a->corner_y[j] * t), 255);
    }
}

static int polygon_corners(const struct refocus_aperture *a)
{
    return a->blades;
}

static struct rf_corner polygon_corner(const struct refocus_aperture *a, int i)
{
    return (struct rf_corner){a->corner_x[i], a->corner_y[i]};
}

const struct rf_shape rf_shape_polygon = {
    .open = polygon_open,
    .rays = polygon_rays,
    .corners = polygon_corners,
    .corner = polygon_corner,
};

int refocus_aperture_create_polygon(struct refocus_aperture **aperture, int blades,
                                    double rotation_deg)
{
    struct refocus_aperture *a;
    int status;

    if (!aperture)
        return REFOCUS_ERR_ARGUMENT;
    *aperture = NULL;
    if (blades < 3 || blades > 16 || !isfinite(rotation_deg))
        return REFOCUS_ERR_ARGUMENT;
    status = rf_shape_create(aperture, &rf_shape_polygon);
    if (status)
        return status;
    a = *aperture;
    a->blades = blades;
    rotation_deg = fmod(rotation_deg, 360);
    for (int i = 0; i < blades; i++) {
        double s, c;

        rf_sincos_turns(rotation_deg / 360 + (double)i / blades, &s, &c);
        a->corner_x[i] = c;
        a->corner_y[i] = -s; /* y down */
    }
    a->id = rf_shape_hash(2, a->corner_x, sizeof a->corner_x);
    a->id = rf_shape_hash(a->id, a->corner_y, sizeof a->corner_y);
    rf_chords_make(a);
    return REFOCUS_OK;
}
