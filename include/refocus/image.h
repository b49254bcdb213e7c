/** @file image.h  Pictures in the caller's memory. */
#ifndef REFOCUS_IMAGE_H
#define REFOCUS_IMAGE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Pixel formats, named by the order of their bytes in memory. */
enum refocus_format {
    REFOCUS_FORMAT_NONE = 0,
    REFOCUS_FORMAT_RGB8 = 1,  /**< 3 bytes a pixel: R, G, B */
    REFOCUS_FORMAT_BGR8 = 2,  /**< 3 bytes a pixel: B, G, R */
    REFOCUS_FORMAT_RGBA8 = 3, /**< 4 bytes a pixel, alpha not premultiplied */
    REFOCUS_FORMAT_BGRA8 = 4, /**< 4 bytes a pixel, alpha not premultiplied */
};

/** Largest width and height of a picture, in pixels. */
enum { REFOCUS_MAX_SIDE = 65535 };

/**
 * A picture. The caller owns the memory; nothing here frees it.
 *
 * Row y of plane i begins at plane[i] + y * stride[i]. A stride may be
 * negative (bottom-up pictures: plane points to the top row) and of any size of
 * at least one row. Packed formats use plane[0] only.
 */
struct refocus_image {
    uint32_t format; /**< enum refocus_format */
    int32_t width;   /**< pixels, 1 to REFOCUS_MAX_SIDE */
    int32_t height;  /**< pixels, 1 to REFOCUS_MAX_SIDE */
    uint8_t *plane[3];
    ptrdiff_t stride[3]; /**< bytes from a row to the next one below */
};

/** A packed picture; see struct refocus_image for the arguments. */
static inline struct refocus_image refocus_image_packed(uint32_t format, void *pixels,
                                                        int32_t width, int32_t height,
                                                        ptrdiff_t stride)
{
    struct refocus_image image;

    memset(&image, 0, sizeof image);
    image.format = format;
    image.width = width;
    image.height = height;
    image.plane[0] = (uint8_t *)pixels;
    image.stride[0] = stride;
    return image;
}

/** Bytes of one pixel of a packed format; 0 for an unknown one. Thread-safe. */
REFOCUS_API int refocus_format_bytes(uint32_t format);

/**
 * A map of disparities in the caller's memory: 1 nearest, 0 farthest.
 *
 * 8-bit samples are read as v / 255, 16-bit ones as v / 65535. 16-bit samples
 * are in the machine's byte order and need an even address and stride.
 */
struct refocus_disparity {
    uint32_t bits;       /**< 8 or 16 */
    int32_t width;       /**< samples, 1 to REFOCUS_MAX_SIDE */
    int32_t height;      /**< samples, 1 to REFOCUS_MAX_SIDE */
    const void *samples; /**< top row */
    ptrdiff_t stride;    /**< bytes from a row to the next one below; may be negative */
};

/** A map of 16-bit disparities; see struct refocus_disparity. */
static inline struct refocus_disparity refocus_disparity16(const uint16_t *samples,
                                                           int32_t width, int32_t height,
                                                           ptrdiff_t stride)
{
    struct refocus_disparity map;

    map.bits = 16;
    map.width = width;
    map.height = height;
    map.samples = samples;
    map.stride = stride;
    return map;
}

#ifdef __cplusplus
}
#endif
#endif
