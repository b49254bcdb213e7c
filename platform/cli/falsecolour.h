/* Pictures of numbers: disparities and blur radii in colours, with a legend below. */
#ifndef RF_CLI_FALSECOLOUR_H
#define RF_CLI_FALSECOLOUR_H

#include <stdint.h>
#include <refocus/image.h>
#include <refocus/lens.h>

/* Disparities, 65535 nearest. The legend adds metres when range is not NULL. Both functions
 * take packed values and return a picture whose plane[0] the caller frees; it is NULL when
 * there is no memory. */
struct refocus_image falsecolour_depth(const uint16_t *values, int width, int height,
                                       const struct refocus_depth_range *range);

/* Blur radii in 1/256 pixel, up to greatest pixels; less than half a pixel is green. */
struct refocus_image falsecolour_blur(const uint16_t *values, int width, int height,
                                      double greatest);

#endif
