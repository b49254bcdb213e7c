/* plane.c: finds planes of focus through points and lines of a photo. 1/z of a plane in space is
 * affine in the picture's coordinates, and disparity is affine in 1/z. */
#include <refocus/render.h>

#include <math.h>
#include <stdbool.h>

#include "aperture/aperture.h"

static bool is_part(float v)
{
    return v >= 0 && v <= 1;
}

static bool good_point(const struct refocus_focus_point *p)
{
    return is_part(p->x) && is_part(p->y) && is_part(p->disparity);
}

static int good_plane(const struct refocus_focus_plane *plane)
{
    return fabsf(plane->across) <= REFOCUS_MAX_TILT && fabsf(plane->down) <= REFOCUS_MAX_TILT
               ? REFOCUS_OK
               : REFOCUS_ERR_ARGUMENT;
}

int refocus_focus_plane_of_points(struct refocus_focus_plane *plane,
                                  const struct refocus_focus_point p[3])
{
    double ax, ay, ad, bx, by, bd, area;

    if (!plane || !p || !good_point(&p[0]) || !good_point(&p[1]) || !good_point(&p[2]))
        return REFOCUS_ERR_ARGUMENT;
    ax = (double)p[1].x - p[0].x;
    ay = (double)p[1].y - p[0].y;
    ad = (double)p[1].disparity - p[0].disparity;
    bx = (double)p[2].x - p[0].x;
    by = (double)p[2].y - p[0].y;
    bd = (double)p[2].disparity - p[0].disparity;
    area = ax * by - ay * bx;
    if (fabs(area) < 1e-9)
        return REFOCUS_ERR_ARGUMENT;
    plane->x = (float)(((double)p[0].x + p[1].x + p[2].x) / 3);
    plane->y = (float)(((double)p[0].y + p[1].y + p[2].y) / 3);
    plane->focus_disparity =
        (float)(((double)p[0].disparity + p[1].disparity + p[2].disparity) / 3);
    plane->across = (float)((ad * by - ay * bd) / area);
    plane->down = (float)((ax * bd - ad * bx) / area);
    return good_plane(plane);
}

int refocus_focus_plane_of_line(struct refocus_focus_plane *plane,
                                const struct refocus_focus_point *from,
                                const struct refocus_focus_point *to, double aspect,
                                double angle_deg)
{
    double dx, dy, length, sine, cosine, slope;

    if (!plane || !from || !to || !good_point(from) || !good_point(to) || !(aspect > 0) ||
        !isfinite(aspect) || !(angle_deg > -90 && angle_deg < 90))
        return REFOCUS_ERR_ARGUMENT;
    dx = (double)to->x - from->x; /* in picture widths */
    dy = ((double)to->y - from->y) * aspect;
    length = sqrt(dx * dx + dy * dy);
    if (length < 1e-6)
        return REFOCUS_ERR_ARGUMENT;
    rf_sincos_turns(angle_deg / 360, &sine, &cosine);
    slope = sine / cosine;
    plane->x = from->x;
    plane->y = from->y;
    plane->focus_disparity = from->disparity;
    /* The plane rises to the right of (dx, dy); y points down. */
    plane->across = (float)(slope * -dy / length);
    plane->down = (float)(slope * dx / length * aspect);
    return good_plane(plane);
}
