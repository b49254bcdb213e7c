/** @file lens.h  The thin lens: from millimetres and metres to pixels of blur.
 *
 * Words and symbols: f focal length, N f-number, R = f / 2N radius of the
 * aperture, z depth in metres along the optical axis, s focal length in pixels,
 * d disparity (1 nearest, 0 farthest), df the disparity in focus, K maximum blur
 * radius in pixels. All functions are thread-safe and return NAN for arguments
 * out of their range.
 */
#ifndef REFOCUS_LENS_H
#define REFOCUS_LENS_H

#include <refocus/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A lens and the sensor behind it. Every field is finite and > 0. */
struct refocus_lens {
    double focal_length_mm; /**< f */
    double f_number;        /**< N */
    double sensor_width_mm; /**< width of the sensor area that the picture shows */
};

/** Depths between which the scene lies. 0 < near_m < far_m; far_m may be INFINITY. */
struct refocus_depth_range {
    double near_m; /**< z0: where d = 1 */
    double far_m;  /**< z1: where d = 0 */
};

/** Radius of the aperture in metres: R = f / 2N. */
REFOCUS_API double refocus_aperture_radius_m(const struct refocus_lens *lens);

/** Focal length in pixels: s = f / sensor width * picture width. */
REFOCUS_API double refocus_focal_length_px(const struct refocus_lens *lens,
                                           double picture_width_px);

/** d = (1/z - 1/z1) / (1/z0 - 1/z1), not clamped. @param depth_m > 0, may be
 *  INFINITY */
REFOCUS_API double refocus_disparity_of_depth(const struct refocus_depth_range *range,
                                              double depth_m);

/** z of a disparity: the inverse of refocus_disparity_of_depth(); INFINITY where 1/z =
 *  0. */
REFOCUS_API double refocus_depth_of_disparity(const struct refocus_depth_range *range,
                                              double disparity);

/**
 * Largest blur radius in pixels, that of the nearest plane when the farthest is
 * in focus: K = s R (1/z0 - 1/z1). Yang et al. 2016, eq. 2 at z = z0.
 */
REFOCUS_API double refocus_max_blur_radius(const struct refocus_lens *lens,
                                           const struct refocus_depth_range *range,
                                           double picture_width_px);

/** The f-number whose largest blur radius is @p max_blur_radius_px (> 0): the
 *  inverse. */
REFOCUS_API double refocus_f_number_of_blur(const struct refocus_lens *lens,
                                            const struct refocus_depth_range *range,
                                            double picture_width_px, double max_blur_radius_px);

/** Blur radius in pixels: r = K |d - df|. Yang et al. 2016, eq. 4. */
REFOCUS_API double refocus_blur_radius(double max_blur_radius_px, double disparity,
                                       double focus_disparity);

/**
 * Diameter on the sensor, in metres, of the circle of confusion of a point at
 * @p depth_m when @p focus_m is in focus, both beyond the focal length:
 *
 *     C = |V_u - V_p| f / (N V_p),  V_x = f x / (x - f)
 *
 * with u = focus_m, p = depth_m, f the focal length and N the f-number;
 * Potmesil & Chakravarty 1981, eq. 8; depths are distances from the lens.
 */
REFOCUS_API double refocus_circle_of_confusion_m(const struct refocus_lens *lens, double focus_m,
                                                 double depth_m);

/** Depths that still look sharp. */
struct refocus_depth_of_field {
    double near_m; /**< U- */
    double far_m;  /**< U+; INFINITY when focused at the hyperfocal distance or
                        beyond */
};

/**
 * Hyperfocal distance in metres for an eye that resolves 1/@p acuity of a
 * distance: H = acuity f / N. Potmesil & Chakravarty 1981 use acuity = 1000.
 */
REFOCUS_API double refocus_hyperfocal_m(const struct refocus_lens *lens, double acuity);

/**
 * Limits of the depth of field, Potmesil & Chakravarty 1981, eq. 5:
 *
 *     U- = H U / (H + U),  U+ = H U / (H - U) when H > U, else INFINITY
 *
 * @param focus_m       U > 0; may be INFINITY
 * @param hyperfocal_m  H > 0, from refocus_hyperfocal_m()
 * @return both fields NAN if an argument is out of its range
 */
REFOCUS_API struct refocus_depth_of_field refocus_depth_of_field_m(double focus_m,
                                                                   double hyperfocal_m);

#ifdef __cplusplus
}
#endif
#endif
