/* lens.c: blur and depth of field of a thin lens, see refocus/lens.h. It uses only + - * / in
 * doubles, which give the same bits everywhere. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <refocus/lens.h>

/* The whole core is compiled alike. 16 is that of processors with arithmetic on halves. */
_Static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16,
               "floats and doubles are rounded to their own width: see same_bits in meson.build");

static bool is_positive(double value)
{
    return value > 0 && value < INFINITY;
}

/* Whether a value is a depth, which may be infinite. */
static bool is_depth(double value)
{
    return value > 0 && 1 / value < INFINITY;
}

static bool is_lens(const struct refocus_lens *lens)
{
    return lens && is_positive(lens->focal_length_mm) && is_positive(lens->f_number) &&
           is_positive(lens->sensor_width_mm);
}

static bool is_range(const struct refocus_depth_range *range)
{
    return range && is_depth(range->near_m) && range->near_m < range->far_m;
}

/* The span 1/z0 - 1/z1, > 0 except for neighbours among the doubles. */
static double dioptres(const struct refocus_depth_range *range)
{
    return 1 / range->near_m - 1 / range->far_m;
}

double refocus_aperture_radius_m(const struct refocus_lens *lens)
{
    if (!is_lens(lens))
        return NAN;
    return lens->focal_length_mm / 1000 / (2 * lens->f_number);
}

double refocus_focal_length_px(const struct refocus_lens *lens, double picture_width_px)
{
    if (!is_lens(lens) || !is_positive(picture_width_px))
        return NAN;
    return lens->focal_length_mm / lens->sensor_width_mm * picture_width_px;
}

double refocus_disparity_of_depth(const struct refocus_depth_range *range, double depth_m)
{
    if (!is_range(range) || !is_depth(depth_m))
        return NAN;
    return (1 / depth_m - 1 / range->far_m) / dioptres(range);
}

double refocus_depth_of_disparity(const struct refocus_depth_range *range, double disparity)
{
    if (!is_range(range) || !isfinite(disparity))
        return NAN;

    const double inverse = disparity * dioptres(range) + 1 / range->far_m;
    return inverse >= 0 ? 1 / inverse : NAN; /* below 0: beyond infinity */
}

double refocus_max_blur_radius(const struct refocus_lens *lens,
                               const struct refocus_depth_range *range, double picture_width_px)
{
    if (!is_range(range))
        return NAN;
    return refocus_focal_length_px(lens, picture_width_px) * refocus_aperture_radius_m(lens) *
           dioptres(range);
}

double refocus_f_number_of_blur(const struct refocus_lens *lens,
                                const struct refocus_depth_range *range, double picture_width_px,
                                double max_blur_radius_px)
{
    if (!is_positive(max_blur_radius_px))
        return NAN;
    /* K is inversely proportional to N. */
    return lens ? lens->f_number * refocus_max_blur_radius(lens, range, picture_width_px) /
                      max_blur_radius_px
                : NAN;
}

double refocus_blur_radius(double max_blur_radius_px, double disparity, double focus_disparity)
{
    if (!(max_blur_radius_px >= 0) || !isfinite(max_blur_radius_px) || !isfinite(disparity) ||
        !isfinite(focus_disparity))
        return NAN;
    return max_blur_radius_px * fabs(disparity - focus_disparity);
}

/*
 * With 1/V = 1/f - 1/x, eq. 8 is
 *
 *     C = f/N |V_u / V_p - 1| = f/N |1/u - 1/p| V_u,    V_u = f / (1 - f/u)
 *
 * which holds for infinite depths too and does not subtract two equal V. Half of it in
 * pixels is s R |1/u - 1/p| V_u / f = K |d - df| / (1 - f/u): eq. 2 of Yang et al.
 * omits the last factor, by which the picture grows when the lens moves out to focus.
 */
double refocus_circle_of_confusion_m(const struct refocus_lens *lens, double focus_m,
                                     double depth_m)
{
    if (!is_lens(lens))
        return NAN;

    const double f = lens->focal_length_mm / 1000;
    if (!(focus_m > f) || !(depth_m > f))
        return NAN;
    return f / lens->f_number * fabs(1 / focus_m - 1 / depth_m) * (f / (1 - f / focus_m));
}

double refocus_hyperfocal_m(const struct refocus_lens *lens, double acuity)
{
    if (!is_lens(lens) || !is_positive(acuity))
        return NAN;
    return acuity * (lens->focal_length_mm / 1000) / lens->f_number;
}

struct refocus_depth_of_field refocus_depth_of_field_m(double focus_m, double hyperfocal_m)
{
    struct refocus_depth_of_field field = {NAN, NAN};

    if (!is_depth(focus_m) || !is_positive(hyperfocal_m))
        return field;
    /* U- = 1 / (1/U + 1/H): H U / (H + U) for an infinite U too. */
    field.near_m = 1 / (1 / focus_m + 1 / hyperfocal_m);
    field.far_m =
        hyperfocal_m > focus_m ? hyperfocal_m * focus_m / (hyperfocal_m - focus_m) : INFINITY;
    return field;
}
