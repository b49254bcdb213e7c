/* focus.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_FOCUS_H
#define REFOCUS_FOCUS_H
#include <stdint.h>
#include <refocus/image.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
enum { REFOCUS_MAX_TAP_RADIUS = 256 };
REFOCUS_API int refocus_focus_at_point(const struct refocus_disparity *map, int x, int y,
                                       int radius, float *focus);
REFOCUS_API int refocus_focus_in_rectangle(const struct refocus_disparity *map, int x, int y,
                                           int width, int height, float *focus);
struct refocus_focus_plane {
    float x, y;
    float focus_disparity;
    float across, down;
};
struct refocus_focus_point {
    float x, y, disparity;
};
REFOCUS_API int refocus_focus_plane_of_points(struct refocus_focus_plane *plane,
                                              const struct refocus_focus_point point[3]);
REFOCUS_API int refocus_focus_plane_of_line(struct refocus_focus_plane *plane,
                                            const struct refocus_focus_point *from,
                                            const struct refocus_focus_point *to, double aspect,
                                            double angle_deg);
#ifdef __cplusplus
}
#endif
#endif
