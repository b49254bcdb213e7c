/* register.c: depth is registered onto colour by a forward warp with a depth buffer. */
#include <math.h>
#include <string.h>
#include <refocus/platform/convert.h>

static int is_sound(const struct refocus_pinhole *p)
{
    return p->width > 0 && p->height > 0 && p->width <= REFOCUS_MAX_SIDE &&
           p->height <= REFOCUS_MAX_SIDE && p->fx > 0 && p->fy > 0 && isfinite(p->fx) &&
           isfinite(p->fy) && isfinite(p->cx) && isfinite(p->cy);
}

/* The point of pixel (x, y) at a distance, in the colour camera's coordinates. */
static void transform(const struct refocus_calibration *c, double x, double y, double z,
                      double point[3])
{
    const double from[3] = {(x - c->depth.cx) / c->depth.fx * z,
                            (y - c->depth.cy) / c->depth.fy * z, z};

    for (int i = 0; i < 3; i++)
        point[i] = c->rotation[3 * i] * from[0] + c->rotation[3 * i + 1] * from[1] +
                   c->rotation[3 * i + 2] * from[2] + c->translation_m[i];
}

static void splat(const struct refocus_calibration *c, double x, double y, double z,
                  double metres_per_unit, uint16_t *out)
{
    const struct refocus_pinhole *colour = &c->colour;
    double low[3], high[3], left, right, top, bottom, units;

    /* The corners of the sample; its middle says how far it is. */
    transform(c, x - 0.5, y - 0.5, z, low);
    transform(c, x + 0.5, y + 0.5, z, high);
    if (!(low[2] > 0 && high[2] > 0))
        return;
    left = fmin(low[0] / low[2], high[0] / high[2]) * colour->fx + colour->cx;
    right = fmax(low[0] / low[2], high[0] / high[2]) * colour->fx + colour->cx;
    top = fmin(low[1] / low[2], high[1] / high[2]) * colour->fy + colour->cy;
    bottom = fmax(low[1] / low[2], high[1] / high[2]) * colour->fy + colour->cy;
    units = (low[2] + high[2]) / 2 / metres_per_unit + 0.5;
    if (!(left > -1e6 && right < 1e6 && top > -1e6 && bottom < 1e6 && units >= 1 && units < 65536))
        return;

    /* Pixels whose centre lies in [left, right) and [top, bottom), at least one. */
    int x0 = (int)ceil(left), x1 = (int)ceil(right), y0 = (int)ceil(top), y1 = (int)ceil(bottom);
    if (x1 == x0)
        x1 = (x0 = (int)floor((left + right) / 2 + 0.5)) + 1;
    if (y1 == y0)
        y1 = (y0 = (int)floor((top + bottom) / 2 + 0.5)) + 1;
    for (int j = y0 < 0 ? 0 : y0; j < y1 && j < colour->height; j++)
        for (int i = x0 < 0 ? 0 : x0; i < x1 && i < colour->width; i++) {
            uint16_t *at = out + (size_t)j * (size_t)colour->width + (size_t)i;

            if (*at == 0 || *at > (uint16_t)units)
                *at = (uint16_t)units;
        }
}

int refocus_register_depth(const struct refocus_calibration *calibration, const uint16_t *samples,
                           double metres_per_unit, uint16_t *out)
{
    if (!calibration || !samples || !out || !(metres_per_unit > 0) || !isfinite(metres_per_unit) ||
        !is_sound(&calibration->depth) || !is_sound(&calibration->colour))
        return REFOCUS_ERR_ARGUMENT;
    for (int i = 0; i < 9; i++)
        if (!isfinite(calibration->rotation[i]) || !isfinite(calibration->translation_m[i % 3]))
            return REFOCUS_ERR_ARGUMENT;
    memset(out, 0, (size_t)calibration->colour.width * (size_t)calibration->colour.height * 2);
    for (int y = 0; y < calibration->depth.height; y++)
        for (int x = 0; x < calibration->depth.width; x++, samples++)
            if (*samples)
                splat(calibration, x, y, *samples * metres_per_unit, metres_per_unit, out);
    return REFOCUS_OK;
}
