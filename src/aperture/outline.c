/* outline.c: irises and figures as outlines that are seen whole from their middle.
 *
 * Such an outline is a radius for each direction. It is kept as RF_OUTLINE vertices at equal
 * steps of the circle: the triangles between the middle and two neighbours have the
 * areas by which rays are spread, and the same triangles say whether a place lies
 * within.
 */
#include "aperture/aperture.h"

#include <math.h>

/* The radius of a side between two corners on the unit circle, `off` turns from its middle. */
static double side_radius(int blades, double curvature, double off)
{
    double half_chord, apothem, sine, cosine, bulge, arc, back;

    rf_sincos_turns(0.5 / blades, &half_chord, &apothem);
    rf_sincos_turns(off, &sine, &cosine);
    bulge = curvature * (1 - apothem);
    if (bulge < 1e-6)
        return apothem / cosine;
    /* `arc` is the radius of the blade, whose centre lies `back` beyond the aperture's middle. */
    arc = (half_chord * half_chord + bulge * bulge) / (2 * bulge);
    back = arc - (apothem + bulge);
    return sqrt(arc * arc - back * back * sine * sine) - back * cosine;
}

/* The turns since the last corner, in parts of a blade: 0 to 1. */
static double along_blade(double turns, int blades)
{
    return turns * blades - floor(turns * blades);
}

static double iris_radius(const struct refocus_aperture_params *p, double turns)
{
    double radius, least, most;

    if (p->blades == 0)
        return 1;
    radius =
        side_radius(p->blades, p->curvature, (along_blade(turns, p->blades) - 0.5) / p->blades);
    if (p->opening == 0)
        return radius;
    least = side_radius(p->blades, p->curvature, 0);
    radius *= p->opening / least;
    /* The corners lie here, or where the barrel cuts them off. */
    most = p->opening / least < 1 ? p->opening / least : 1;
    return (radius < 1 ? radius : 1) / most;
}

/* The radius of a star: straight lines between points at 1 and notches at 0.382, the inverse square
 * of the golden ratio. */
static double star_radius(int points, double turns)
{
    const double part = along_blade(turns, points);
    const double off = (part < 0.5 ? part : 1 - part) / points, notch = 0.38196601125010515;
    double sine, cosine, dx, dy;

    rf_sincos_turns(0.5 / points, &sine, &cosine);
    dx = notch * cosine - 1;
    dy = notch * sine;
    rf_sincos_turns(off, &sine, &cosine);
    return dy / (cosine * dy - sine * dx);
}

/* The radius of the heart (x^2 + y^2 - 1)^3 = x^2 y^3, its middle moved up by 0.14 and all of it
 * scaled by 1 / 1.26 to lie within radius 1. */
static double heart_radius(double turns)
{
    double low = 0, high = 1, sine, cosine;

    rf_sincos_turns(turns, &sine, &cosine);
    for (int i = 0; i < 50; i++) {
        const double r = (low + high) / 2;
        const double x = 1.26 * r * cosine, y = 1.26 * r * sine + 0.14;
        const double c = x * x + y * y - 1;

        if (c * c * c - x * x * y * y * y <= 0)
            low = r;
        else
            high = r;
    }
    return low;
}

static double radius_at(const struct refocus_aperture_params *p, double turns)
{
    switch (p->figure) {
    case REFOCUS_FIGURE_HEART:
        return heart_radius(turns);
    case REFOCUS_FIGURE_STAR:
        return star_radius(p->blades ? p->blades : 5, turns - 0.25); /* one point up */
    default:
        return iris_radius(p, turns);
    }
}

void rf_outline_make(struct refocus_aperture *a, const struct refocus_aperture_params *p)
{
    const double rotation = p->rotation_deg / 360;
    double sum = 0;

    for (int i = 0; i < RF_OUTLINE; i++) {
        const double turns = (double)i / RF_OUTLINE;
        const double radius = radius_at(p, turns - rotation);
        double sine, cosine;

        rf_sincos_turns(turns, &sine, &cosine);
        a->vertex_x[i] = radius * cosine;
        a->vertex_y[i] = radius * sine;
    }
    a->vertex_x[RF_OUTLINE] = a->vertex_x[0];
    a->vertex_y[RF_OUTLINE] = a->vertex_y[0];
    for (int i = 0; i < RF_OUTLINE; i++) {
        a->area[i] = sum;
        sum += a->vertex_x[i] * a->vertex_y[i + 1] - a->vertex_y[i] * a->vertex_x[i + 1];
    }
    for (int i = 0; i < RF_OUTLINE; i++)
        a->area[i] /= sum;
    a->area[RF_OUTLINE] = 1;
}

void rf_outline_at(const struct refocus_aperture *a, double share, double *x, double *y)
{
    int low = 0, high = RF_OUTLINE;
    double part;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (a->area[middle] <= share)
            low = middle;
        else
            high = middle;
    }
    part = (share - a->area[low]) / (a->area[high] - a->area[low]);
    *x = a->vertex_x[low] + part * (a->vertex_x[high] - a->vertex_x[low]);
    *y = a->vertex_y[low] + part * (a->vertex_y[high] - a->vertex_y[low]);
}

double rf_outline_square(const struct refocus_aperture *a, double x, double y)
{
    const bool lower = y < 0 || (y == 0 && x < 0);
    int low = lower ? RF_OUTLINE / 2 : 0, high = low + RF_OUTLINE / 2;
    double ex, ey, ratio;

    while (high - low > 1) { /* find the triangle in the direction of the place */
        const int middle = (low + high) / 2;

        if (a->vertex_x[middle] * y - a->vertex_y[middle] * x >= 0)
            low = middle;
        else
            high = middle;
    }
    ex = a->vertex_x[high] - a->vertex_x[low];
    ey = a->vertex_y[high] - a->vertex_y[low];
    ratio = (ex * y - ey * x) / (ex * a->vertex_y[low] - ey * a->vertex_x[low]);
    return ratio * ratio;
}
