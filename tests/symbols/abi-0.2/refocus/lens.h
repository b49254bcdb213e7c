/* lens.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_LENS_H
#define REFOCUS_LENS_H
#include <refocus/version.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_lens {
    double focal_length_mm;
    double f_number;
    double sensor_width_mm;
};
struct refocus_depth_range {
    double near_m;
    double far_m;
};
REFOCUS_API double refocus_aperture_radius_m(const struct refocus_lens *lens);
REFOCUS_API double refocus_focal_length_px(const struct refocus_lens *lens,
                                           double picture_width_px);
REFOCUS_API double refocus_disparity_of_depth(const struct refocus_depth_range *range,
                                              double depth_m);
REFOCUS_API double refocus_depth_of_disparity(const struct refocus_depth_range *range,
                                              double disparity);
REFOCUS_API double refocus_max_blur_radius(const struct refocus_lens *lens,
                                           const struct refocus_depth_range *range,
                                           double picture_width_px);
REFOCUS_API double refocus_f_number_of_blur(const struct refocus_lens *lens,
                                            const struct refocus_depth_range *range,
                                            double picture_width_px, double max_blur_radius_px);
REFOCUS_API double refocus_blur_radius(double max_blur_radius_px, double disparity,
                                       double focus_disparity);
REFOCUS_API double refocus_circle_of_confusion_m(const struct refocus_lens *lens, double focus_m,
                                                 double depth_m);
struct refocus_depth_of_field {
    double near_m;
    double far_m;
};
REFOCUS_API double refocus_hyperfocal_m(const struct refocus_lens *lens, double acuity);
REFOCUS_API struct refocus_depth_of_field refocus_depth_of_field_m(double focus_m,
                                                                   double hyperfocal_m);
#ifdef __cplusplus
}
#endif
#endif
