/* yuv.h: pictures of R, G, B in formats of Y, U, V and back, as a camera and a display do:
 * BT.601, limited range, U and V the mean of the pixels that share them, or repeated for them. */
#ifndef QUALITY_YUV_H
#define QUALITY_YUV_H

#include <refocus/image.h>

/* RGB8 into a picture of any format of Y, U, V and of the same size; its range and matrix. */
void yuv_from_rgb(const struct refocus_image *rgb, const struct refocus_image *yuv);
void yuv_to_rgb(const struct refocus_image *yuv, const struct refocus_image *rgb);

#endif
