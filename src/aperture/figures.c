/* figures.c: the outlines of irises and of figures, as a radius for each direction.
 *
 * A new figure is a function here, a row of the table below, and a value of enum refocus_figure.
 * Its outline must be seen whole from the middle, lie within radius 1 and reach it.
 */
#include "aperture/aperture.h"
#include "aperture/shape.h"

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
static double star_radius(const struct refocus_aperture_params *p, double turns)
{
    const int points = p->blades ? p->blades : 5;
    const double part = along_blade(turns - 0.25, points); /* one point up */
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
static double heart_radius(const struct refocus_aperture_params *p, double turns)
{
    double low = 0, high = 1, sine, cosine;

    (void)p;
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

typedef double radius_fn(const struct refocus_aperture_params *p, double turns);

static radius_fn *const radius_of[REFOCUS_FIGURE_COUNT] = {
    [REFOCUS_FIGURE_NONE] = iris_radius,
    [REFOCUS_FIGURE_HEART] = heart_radius,
    [REFOCUS_FIGURE_STAR] = star_radius,
};

double rf_outline_radius(const struct refocus_aperture_params *p, double turns)
{
    return radius_of[p->figure](p, turns);
}
