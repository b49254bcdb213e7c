/* chroma.h: how a photo of Y, U and V is coded, and the planes of its chroma.
 *
 * Planes of chroma hold two values for each sample, D_b and D_r of colour/yuv.h, side by side: a
 * tile's are as wide as the tile, and what is done to luma by rows is done to them in the same way.
 * Luminance is in channel[0] of planes of light.
 */
#ifndef RF_CHROMA_H
#define RF_CHROMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <refocus/image.h>

#include "colour/yuv.h"
#include "image/planes.h"

/* How the prepared photo is coded, and its curve in the blend in use. */
struct rf_yuv {
    bool on;                       /* else it is of R, G and B, and the rest is not valid */
    int down;                      /* rows of the photo to one of chroma: 1 << down */
    uint32_t matrix, range, blend; /* select the curve */
    bool curve_made;
    struct rf_yuv_curve curve;
};

/* Takes over how a photo is coded, of whatever format it is; then changes to another blend. */
void rf_yuv_begin(struct rf_yuv *yuv, const struct refocus_image *photo, uint32_t blend);
void rf_yuv_set_blend(struct rf_yuv *yuv, uint32_t blend);

/* Samples of chroma in the window: one for 2 x 2 pixels, or 2 x 1 where down is 0. */
struct rf_chroma_size {
    int width, height; /* samples */
    int down;
};

/* The row of chroma after the last one of rows of pixels that end at y1. */
static inline int rf_chroma_end(int down, int y1)
{
    return (y1 + down) >> down;
}

/* D_b and D_r of each sample, Q12 with RF_CHROMA_ZERO added: sample x of row y begins at
 * at[y * stride + 2 * x]. Padded. */
struct rf_chroma_q12 {
    uint16_t *at;
    ptrdiff_t stride;
};

/* The codes of the photo as they came in: one Y a pixel, and U and V of each sample side by side.
 * Strides are in bytes. */
struct rf_yuv_codes {
    uint8_t *y, *uv;
    ptrdiff_t y_stride, uv_stride;
};

/* All of a photo of Y, U and V that has no place in the planes of R, G and B. */
struct rf_chroma_planes {
    struct rf_chroma_size size;
    struct rf_chroma_q12 light;      /* the photo's own */
    struct rf_chroma_q12 smooth;     /* pre-filtered */
    struct rf_chroma_q12 background; /* hidden background */
    struct rf_blur_q8 blur;          /* given twice for each sample */
    struct rf_yuv_codes codes;
};

#endif
