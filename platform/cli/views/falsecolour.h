/* falsecolour.h: pictures of numbers: disparities and blur radii in colours, with a legend below.
 */
#ifndef RF_CLI_FALSECOLOUR_H
#define RF_CLI_FALSECOLOUR_H

#include <stdint.h>
#include <refocus/image.h>
#include <refocus/lens.h>

/* Disparities, 65535 nearest. The legend adds metres when range is not NULL; where
 * there is a photo, of RGB8 and the same size, the colours lie half over its grey. Both
 * functions take packed values and return a picture whose plane[0] the caller frees; it
 * is NULL when there is no memory. */
struct refocus_image falsecolour_depth(const uint16_t *values, int width, int height,
                                       const struct refocus_depth_range *range,
                                       const struct refocus_image *photo);

/* The disparities between which the blur is less than half a pixel; beyond 0 and 1
 * there is nothing. */
struct blur_limits {
    double near_disparity, far_disparity;
};

/* Blur radii in 1/256 pixel, up to greatest pixels. What is less than half a pixel is
 * green, with a line where it ends: magenta where nearer things begin, white where
 * farther ones do, by the disparities. The legend names the limits, if they are not
 * NULL, in metres too when range is not. */
struct refocus_image falsecolour_blur(const uint16_t *values, const uint16_t *disparity, int width,
                                      int height, double greatest,
                                      const struct refocus_depth_range *range,
                                      const struct blur_limits *limits);

#endif
