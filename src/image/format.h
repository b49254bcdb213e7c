/* format.h: where R, G, B and alpha stand in a pixel, and checks of pictures and maps. */
#ifndef RF_FORMAT_H
#define RF_FORMAT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include <refocus/image.h>

struct rf_order {
    int bytes, r, g, b, a; /* a < 0: no alpha */
};

static inline struct rf_order rf_order_of(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
        return (struct rf_order){3, 0, 1, 2, -1};
    case REFOCUS_FORMAT_BGR8:
        return (struct rf_order){3, 2, 1, 0, -1};
    case REFOCUS_FORMAT_RGBA8:
        return (struct rf_order){4, 0, 1, 2, 3};
    default:
        return (struct rf_order){4, 2, 1, 0, 3};
    }
}

/* Whether a format has more than 8 bits a channel: refocus_prepare() and refocus_render() take it.
 */
static inline bool rf_is_deep(uint32_t format)
{
    return format >= REFOCUS_FORMAT_RGB16 && format <= REFOCUS_FORMAT_P016;
}

/* Whether a format has 8 bits of Y, U and V: planes of luminance and chroma are for these. */
static inline bool rf_is_yuv8(uint32_t format)
{
    return refocus_format_is_yuv(format) && !rf_is_deep(format);
}

/* Whether rows of `bytes` bytes, `rows` of them, can lie `stride` apart: without overlap, and so
 * that the place of each row is a ptrdiff_t. No -stride here, which PTRDIFF_MIN has not. */
static inline bool rf_good_stride(ptrdiff_t stride, ptrdiff_t bytes, int rows)
{
    const ptrdiff_t most = PTRDIFF_MAX / rows;

    return stride >= -most && stride <= most && (rows == 1 || stride >= bytes || stride <= -bytes);
}

/* The number of rows of pixels to a row of chroma is 1 << this. */
static inline int rf_chroma_down(uint32_t format)
{
    return format == REFOCUS_FORMAT_YUYV ? 0 : 1;
}

#endif
