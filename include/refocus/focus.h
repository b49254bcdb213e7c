/** @file focus.h  From what is tapped on a photo to what is in focus.
 *
 * The maps are those of render.h: disparities of the photo's size, 65535 (or 255)
 * nearest; refocus_get_view() has the prepared one. All functions are thread-safe and
 * give the same result everywhere.
 */
#ifndef REFOCUS_FOCUS_H
#define REFOCUS_FOCUS_H

#include <stdint.h>
#include <refocus/image.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest radius of a tap in pixels. */
enum { REFOCUS_MAX_TAP_RADIUS = 256 };

/**
 * The disparity of the surface that is tapped: of the disparities within @p radius of
 * the pixel, split into surfaces where 1/64 is empty between them, the median of the
 * nearest surface that has a quarter of the disc, or of the largest if none has. So a
 * tap beside an edge takes the object before it, and single wrong samples do not
 * matter.
 *
 * @param x, y    pixel of the map
 * @param radius  1 to REFOCUS_MAX_TAP_RADIUS pixels; 0 = 1/256 of the larger side, at
 *                least 3
 * @param focus   receives df, 0 to 1
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (also for a pixel outside of the map)
 */
REFOCUS_API int refocus_focus_at_point(const struct refocus_disparity *map, int x, int y,
                                       int radius, float *focus);

/**
 * Finds the disparity of what a rectangle shows, a face or an autofocus area: the median of
 * the nearest surface that has a quarter of it, or of the largest if none has.
 *
 * @param x, y, width, height  a part of the map, at least a pixel
 * @param focus                receives df, 0 to 1
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (also for what is not within the map)
 */
REFOCUS_API int refocus_focus_in_rectangle(const struct refocus_disparity *map, int x, int y,
                                           int width, int height, float *focus);

/** A plane of focus: the disparity in focus is an affine function of the place in the
 *  photo, because 1/z of a plane is. See struct refocus_focus_params. */
struct refocus_focus_plane {
    float x, y;            /**< place at which focus_disparity holds, 0 to 1 of width and
                                height */
    float focus_disparity; /**< there, 0 to 1 */
    float across, down;    /**< growth over the width and over the height */
};

/** A point of a photo: place, 0 to 1 of width and height, and disparity, 0 to 1. */
struct refocus_focus_point {
    float x, y, disparity;
};

/**
 * The plane of focus through three points, a view camera's.
 *
 * @param plane  receives it; x, y and focus_disparity are the mean of the points
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (a value out of its range, the points on one
 *         line, or a plane that grows by more than REFOCUS_MAX_TILT)
 */
REFOCUS_API int refocus_focus_plane_of_points(struct refocus_focus_plane *plane,
                                              const struct refocus_focus_point point[3]);

/**
 * The plane of focus that contains a line of equal disparity and rises from it at an
 * angle.
 *
 * @param from, to  two places of the line, which must differ; the disparity of `from`
 *                  holds all along it
 * @param aspect    height / width of the photo, > 0
 * @param angle_deg above -90, below 90: in the space of places in parts of the width
 *                  and of disparities. 45 = over a picture's width from the farthest to
 *                  the nearest. The disparity in focus grows to the right of the line,
 *                  going from `from` to `to` as the photo is seen.
 * @return as refocus_focus_plane_of_points()
 */
REFOCUS_API int refocus_focus_plane_of_line(struct refocus_focus_plane *plane,
                                            const struct refocus_focus_point *from,
                                            const struct refocus_focus_point *to, double aspect,
                                            double angle_deg);

#ifdef __cplusplus
}
#endif
#endif
