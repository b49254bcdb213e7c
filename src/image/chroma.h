/* chroma.h: the planes of a photo of Y, U and V beside those of its luminance. */
#ifndef RF_CHROMA_H
#define RF_CHROMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "colour/yuv.h"

/*
 * A photo of Y, U and V. Luminance is in light[0] of the layers. Planes of chroma hold two
 * values for each sample, D_b and D_r of colour/yuv.h, side by side: a tile's are as wide as the
 * tile, and what is done to luma by rows is done to them in the same way. They take the place of
 * the layers' light[1], and use their stride; the blur of chroma, given twice, that of
 * smooth[2]. The codes that came in are kept: Y in place of alpha, U V in that of light[2].
 * front.light[1] and [2] are luminance, too, for those who ask for the brightest.
 */
struct rf_yuv {
    bool on;                       /* else it is of R, G and B, and the rest is not valid */
    int down;                      /* rows of the photo to one of chroma: 1 << down */
    uint32_t matrix, range, blend; /* that curve is for */
    bool curve_made;
    struct rf_yuv_curve curve;

    /* Of the window, by rf_yuv_use(). */
    int width, height; /* samples of chroma */
    uint16_t *light;   /* of the photo, */
    uint16_t *smooth;  /* pre-filtered */
    uint16_t *behind;  /* and of the background */
    int16_t *blur;
    uint16_t *weight; /* eq. 5, of luma; in the background's light[2] */
    uint8_t *y;       /* y_stride a row */
    uint8_t *uv;      /* 2 width a row, rows uv_stride apart */
    ptrdiff_t y_stride, uv_stride;
};

#endif
