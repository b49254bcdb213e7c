/* resize.h: pictures are made smaller by the mean of areas, in linear light. */
#ifndef RF_CLI_RESIZE_H
#define RF_CLI_RESIZE_H

#include <stdbool.h>
#include <refocus/image.h>

/* A size that is asked for: the most of each side in pixels, 0 for any; or a part of both. */
struct resize {
    int width, height;
    double part; /* 0: none */
};

/* Parse "W", "WxH" or "N%"; false when it is none of them, or no size. */
bool resize_parse(const char *text, struct resize *size);

/* The size of a picture after it: never larger, at least one pixel, of the same shape. */
void resize_fit(const struct resize *size, int width, int height, int *new_width, int *new_height);

/* Make a smaller picture of RGB8, RGB16 or floats, packed as its pixels of plane[0] are, which are
 * to be freed. REFOCUS_OK, REFOCUS_ERR_MEMORY, or REFOCUS_ERR_UNSUPPORTED for another format or
 * curve. */
int resize_image(const struct refocus_image *picture, int width, int height,
                 struct refocus_image *small);

#endif
