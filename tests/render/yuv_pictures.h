/* yuv_pictures.h: photos of Y, U and V for the render tests. */
#ifndef RENDER_YUV_PICTURES_H
#define RENDER_YUV_PICTURES_H

#include "pictures.h"

/* A picture in memory of its own, rows `gap` bytes longer than they need to be, and with a
 * margin before and after each plane, all filled with 0xaa. */
struct yuv_picture {
    struct refocus_image image;
    uint8_t *memory;
    size_t bytes;
};

extern const uint32_t yuv_formats[4];

struct yuv_picture yuv_make(uint32_t format, int width, int height, int gap);
void yuv_free(struct yuv_picture *p);

/* A sample; i is 0 for Y, 1 for U, 2 for V, of the pixel (x, y). */
uint8_t *yuv_sample(const struct refocus_image *image, int i, int x, int y);

/* From R, G, B by BT.601 in limited range, U and V the means of their pixels. */
void yuv_from_picture(const struct yuv_picture *to, const struct picture *from);

/* Any codes at all. */
void yuv_noise(const struct yuv_picture *p, uint32_t seed);

/* Fails with the first pixel or sample that differs; both of any format. */
void assert_same_yuv(const struct refocus_image *a, const struct refocus_image *b,
                     const char *what);

/* Fails where a byte that is no sample was written. */
void assert_margins(const struct yuv_picture *p, const char *what);

#endif
