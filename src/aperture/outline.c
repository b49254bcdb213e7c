/* outline.c: irises and figures as outlines that are seen whole from their middle.
 *
 * Such an outline is a radius for each direction. It is kept as RF_OUTLINE vertices at equal
 * steps of the circle: the triangles between the middle and two neighbours have the
 * areas by which rays are spread, and the same triangles say whether a place lies
 * within.
 */
#include "aperture/aperture.h"
#include "aperture/shape.h"

#include <math.h>

static void make_vertices(struct refocus_aperture *a, const struct refocus_aperture_params *p)
{
    const double rotation = p->rotation_deg / 360;
    double sum = 0;

    for (int i = 0; i < RF_OUTLINE; i++) {
        const double turns = (double)i / RF_OUTLINE;
        const double radius = rf_outline_radius(p, turns - rotation);
        double sine, cosine;

        rf_sincos_turns(turns, &sine, &cosine);
        a->tables->vertex_x[i] = radius * cosine;
        a->tables->vertex_y[i] = radius * sine;
    }
    a->tables->vertex_x[RF_OUTLINE] = a->tables->vertex_x[0];
    a->tables->vertex_y[RF_OUTLINE] = a->tables->vertex_y[0];
    for (int i = 0; i < RF_OUTLINE; i++) {
        a->tables->area[i] = sum;
        sum += a->tables->vertex_x[i] * a->tables->vertex_y[i + 1] -
               a->tables->vertex_y[i] * a->tables->vertex_x[i + 1];
    }
    for (int i = 0; i < RF_OUTLINE; i++)
        a->tables->area[i] /= sum;
    a->tables->area[RF_OUTLINE] = 1;
}

/* Finds the place on an outline before which lies a share of its area, counter-clockwise. */
static void place_at(const struct refocus_aperture *a, double share, double *x, double *y)
{
    int low = 0, high = RF_OUTLINE;
    double part;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (a->tables->area[middle] <= share)
            low = middle;
        else
            high = middle;
    }
    part = (share - a->tables->area[low]) / (a->tables->area[high] - a->tables->area[low]);
    *x = a->tables->vertex_x[low] + part * (a->tables->vertex_x[high] - a->tables->vertex_x[low]);
    *y = a->tables->vertex_y[low] + part * (a->tables->vertex_y[high] - a->tables->vertex_y[low]);
}

/* The rho^2 of a place, 1 on the outline. */
static double square_of(const struct refocus_aperture *a, double x, double y)
{
    const bool lower = y < 0 || (y == 0 && x < 0);
    int low = lower ? RF_OUTLINE / 2 : 0, high = low + RF_OUTLINE / 2;
    double ex, ey, ratio;

    while (high - low > 1) { /* find the triangle in the direction of the place */
        const int middle = (low + high) / 2;

        if (a->tables->vertex_x[middle] * y - a->tables->vertex_y[middle] * x >= 0)
            low = middle;
        else
            high = middle;
    }
    ex = a->tables->vertex_x[high] - a->tables->vertex_x[low];
    ey = a->tables->vertex_y[high] - a->tables->vertex_y[low];
    ratio = (ex * y - ey * x) / (ex * a->tables->vertex_y[low] - ey * a->tables->vertex_x[low]);
    return ratio * ratio;
}

static int outline_open(const struct refocus_aperture *a, double x, double y)
{
    const double wide = x / a->squeeze_x, high = -y / a->squeeze_y;
    double square;

    if (wide * wide + high * high > 1.0001) /* no figure is larger than its circle */
        return 0;
    square = square_of(a, wide, high);
    return square <= 1 ? rf_shape_light(a, 255, square) : 0;
}

/* Draws the spiral onto the outline by its triangles; its radii are those of equal light. */
static void outline_rays(const struct refocus_aperture *a, int count, bool before,
                         struct refocus_ray *rays, struct rf_run *run)
{
    const struct rf_profile *profile = before ? &a->before : &a->behind;

    (void)run;
    for (int n = 0; n < count; n++) {
        double r, t, x, y;

        rf_spiral(n, count, &r, &t);
        r = sqrt(rf_profile_square(profile, (n + 0.5) / count));
        place_at(a, t, &x, &y);
        rays[n] = rf_squeezed_ray(a, r * x, -r * y);
    }
}

static int outline_corners(const struct refocus_aperture *a)
{
    (void)a;
    return RF_OUTLINE;
}

static struct rf_corner outline_corner(const struct refocus_aperture *a, int i)
{
    return (struct rf_corner){a->tables->vertex_x[i] * a->squeeze_x,
                              -a->tables->vertex_y[i] * a->squeeze_y};
}

const struct rf_shape rf_shape_outline = {
    .open = outline_open,
    .rays = outline_rays,
    .corners = outline_corners,
    .corner = outline_corner,
};

int rf_outline_create(struct refocus_aperture **aperture, const struct refocus_aperture_params *p)
{
    struct refocus_aperture *a;
    const int status = rf_shape_create(aperture, &rf_shape_outline);

    if (status)
        return status;
    a = *aperture;
    make_vertices(a, p);
    a->figure = p->figure != REFOCUS_FIGURE_NONE;
    a->id = rf_shape_hash(4, a->tables->vertex_x, sizeof a->tables->vertex_x);
    a->id = rf_shape_hash(a->id, a->tables->vertex_y, sizeof a->tables->vertex_y);
    return REFOCUS_OK;
}
