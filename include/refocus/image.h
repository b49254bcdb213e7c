/** @file image.h  Pictures in the caller's memory. */
#ifndef REFOCUS_IMAGE_H
#define REFOCUS_IMAGE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/sized.h>
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
    REFOCUS_FORMAT_NV12 = 5,  /**< 4:2:0: plane 0 of Y, plane 1 of U V */
    REFOCUS_FORMAT_NV21 = 6,  /**< 4:2:0: plane 0 of Y, plane 1 of V U */
    REFOCUS_FORMAT_I420 = 7,  /**< 4:2:0: planes of Y, U and V; also called YUV420,
                                   YU12 */
    REFOCUS_FORMAT_YUYV = 8,  /**< 4:2:2 in plane 0: Y U Y V for two pixels */

    /* Deep formats: samples in the machine's byte order at any address, alpha not
     * premultiplied, transfer and white as struct refocus_image says. */
    REFOCUS_FORMAT_RGB16 = 9,       /**< 6 bytes a pixel: R, G, B of 16 bits, 0 to 65535 */
    REFOCUS_FORMAT_RGBA16 = 10,     /**< 8 bytes a pixel */
    REFOCUS_FORMAT_RGB_HALF = 11,   /**< 6 bytes a pixel: floats of 16 bits, IEEE 754 */
    REFOCUS_FORMAT_RGBA_HALF = 12,  /**< 8 bytes a pixel */
    REFOCUS_FORMAT_RGB_FLOAT = 13,  /**< 12 bytes a pixel: floats of 32 bits */
    REFOCUS_FORMAT_RGBA_FLOAT = 14, /**< 16 bytes a pixel */
    REFOCUS_FORMAT_P010 = 15,       /**< 4:2:0 of 16 bits, 10 of them used, the upper ones: plane 0
                                         of Y, plane 1 of U V */
    REFOCUS_FORMAT_P016 = 16,       /**< P010 with all 16 bits used */
};

/** The curve from stored values, 0 to 1 (integers by their largest; floats as they are), to
 *  light, of deep formats. Of others it is sRGB's, or another blend of struct
 *  refocus_render_params. */
enum refocus_transfer {
    REFOCUS_TRANSFER_DEFAULT = 0, /**< sRGB of 16 bits; linear of floats */
    REFOCUS_TRANSFER_SRGB = 1,    /**< continued above 1 */
    REFOCUS_TRANSFER_LINEAR = 2,  /**< stored values are light: they are averaged as they are */
    REFOCUS_TRANSFER_BT709 = 3,
    REFOCUS_TRANSFER_PQ = 4,    /**< SMPTE ST 2084: 1 is 10,000 cd/m2 */
    REFOCUS_TRANSFER_HLG = 5,   /**< BT.2100, light of the scene: 1 is 1 */
    REFOCUS_TRANSFER_GAMMA = 6, /**< light = value ^ gamma */
};

/** The weights of R, G and B in Y: Y = Kr R + (1 - Kr - Kb) G + Kb B. */
enum refocus_matrix {
    REFOCUS_MATRIX_BT601 = 0,  /**< Kr = 0.299, Kb = 0.114 */
    REFOCUS_MATRIX_BT709 = 1,  /**< Kr = 0.2126, Kb = 0.0722 */
    REFOCUS_MATRIX_BT2020 = 2, /**< Kr = 0.2627, Kb = 0.0593; of P010 and P016 alone */
};

/** Codes of black and white in Y, and of U and V: of 8 bits, or in units of the upper 8 of more;
 * 255 stands for the largest code. */
enum refocus_range {
    REFOCUS_RANGE_LIMITED = 0, /**< Y 16 to 235, U and V 128 +- 112 */
    REFOCUS_RANGE_FULL = 1,    /**< Y 0 to 255, U and V 128 +- 127.5 */
};

/** Largest width and height of a picture, in pixels. */
enum { REFOCUS_MAX_SIDE = 65535 };

/**
 * A picture. The caller owns the memory; nothing here frees it.
 *
 * Row y of plane i begins at plane[i] + y * stride[i]. A stride may be
 * negative (bottom-up pictures: plane points to the top row) and of any size of
 * at least one row and at most PTRDIFF_MAX / rows; of a single row of any size up to
 * that. So is every stride of this library. Packed formats use plane[0] only. Start from
 * refocus_image_packed() or refocus_image_planar().
 */
struct refocus_image {
    uint32_t struct_size; /**< sizeof(struct refocus_image); see sized.h */
    uint32_t format;      /**< enum refocus_format */
    int32_t width;        /**< pixels, 1 to REFOCUS_MAX_SIDE */
    int32_t height;       /**< pixels, 1 to REFOCUS_MAX_SIDE */
    uint8_t *plane[3];
    ptrdiff_t stride[3]; /**< bytes from a row to the next one below */
    uint32_t matrix;     /**< enum refocus_matrix; of formats with Y */
    uint32_t range;      /**< enum refocus_range; of formats with Y */
    uint32_t transfer;   /**< enum refocus_transfer; of deep formats, 0 of others */
    float gamma;         /**< 1 to 5, with REFOCUS_TRANSFER_GAMMA; 0 = 2.2 */
    float white;         /**< light that a display shows as white, of deep formats: in cd/m2 of PQ,
                              in what the curve gives of others, 2^-16 to 2^16; 0 = 203 of PQ, 0.265
                              of HLG (75 % of the signal, BT.2408), else 1 */
    uint32_t reserved;   /**< 0 */
};

/** A packed picture; see struct refocus_image for the arguments. */
static inline struct refocus_image
refocus_image_packed(uint32_t format, void *pixels, int32_t width, int32_t height, ptrdiff_t stride)
{
    struct refocus_image image;

    memset(&image, 0, sizeof image);
    image.struct_size = sizeof image;
    image.format = format;
    image.width = width;
    image.height = height;
    image.plane[0] = (uint8_t *)pixels;
    image.stride[0] = stride;
    return image;
}

/** refocus_struct_read() of a picture, for libraries that take one; its size alone is checked. */
static inline int refocus_image_read(struct refocus_image *own, const struct refocus_image *given)
{
    return refocus_struct_read(own, sizeof *own, REFOCUS_SIZE_TO(struct refocus_image, range),
                               given);
}

/** Bytes of one pixel of a packed format of R, G and B; 0 for any other.
 *  Thread-safe. */
REFOCUS_API int refocus_format_bytes(uint32_t format);

/** Whether a format is one of Y, U and V. Thread-safe. */
REFOCUS_API int refocus_format_is_yuv(uint32_t format);

/** Planes of a format; 0 for an unknown one. Thread-safe. */
REFOCUS_API int refocus_format_planes(uint32_t format);

/** Bytes of a row of plane @p plane of a picture of @p width pixels, and the rows of
 *  that plane of one of @p height; 0 for a plane or format that is not, and for a side
 *  beyond 1 to REFOCUS_MAX_SIDE. Thread-safe. */
REFOCUS_API ptrdiff_t refocus_plane_row_bytes(uint32_t format, int plane, int32_t width);
REFOCUS_API int32_t refocus_plane_rows(uint32_t format, int plane, int32_t height);

/**
 * A picture whose planes follow each other in one block of memory, rows without gaps,
 * BT.601 in limited range; refocus_image_bytes() long. With NULL all planes are NULL, and
 * the strides are set. An unknown format or a side out of its range makes what every
 * function refuses.
 */
static inline struct refocus_image refocus_image_planar(uint32_t format, void *memory,
                                                        int32_t width, int32_t height)
{
    struct refocus_image image = refocus_image_packed(format, memory, width, height, 0);
    uint8_t *at = (uint8_t *)memory;
    int plane;

    for (plane = 0; plane < refocus_format_planes(format); plane++) {
        image.plane[plane] = at;
        image.stride[plane] = refocus_plane_row_bytes(format, plane, width);
        if (!at)
            continue;
        at += (size_t)image.stride[plane] * (size_t)refocus_plane_rows(format, plane, height);
    }
    return image;
}

/** Bytes of a picture's planes, rows without gaps; 0 for an unknown format or a side
 *  out of its range. Thread-safe. */
static inline uint64_t refocus_image_bytes(uint32_t format, int32_t width, int32_t height)
{
    uint64_t bytes = 0;
    int plane;

    for (plane = 0; plane < refocus_format_planes(format); plane++)
        bytes += (uint64_t)refocus_plane_row_bytes(format, plane, width) *
                 (uint64_t)refocus_plane_rows(format, plane, height);
    return bytes;
}

/**
 * A map of disparities in the caller's memory: 1 nearest, 0 farthest.
 *
 * 8-bit samples are read as v / 255, 16-bit ones as v / 65535. 16-bit samples
 * are in the machine's byte order and need an even address and stride. Start from
 * refocus_disparity16() or refocus_disparity8().
 */
struct refocus_disparity {
    uint32_t struct_size; /**< sizeof(struct refocus_disparity); see sized.h */
    uint32_t bits;        /**< 8 or 16 */
    int32_t width;        /**< samples, 1 to REFOCUS_MAX_SIDE */
    int32_t height;       /**< samples, 1 to REFOCUS_MAX_SIDE */
    const void *samples;  /**< top row */
    ptrdiff_t stride;     /**< bytes from a row to the next one below; may be negative */
};

/** A map of 16-bit disparities; see struct refocus_disparity. */
static inline struct refocus_disparity refocus_disparity16(const uint16_t *samples, int32_t width,
                                                           int32_t height, ptrdiff_t stride)
{
    struct refocus_disparity map;

    memset(&map, 0, sizeof map);
    map.struct_size = sizeof map;
    map.bits = 16;
    map.width = width;
    map.height = height;
    map.samples = samples;
    map.stride = stride;
    return map;
}

/** A map of 8-bit disparities; see struct refocus_disparity. */
static inline struct refocus_disparity refocus_disparity8(const uint8_t *samples, int32_t width,
                                                          int32_t height, ptrdiff_t stride)
{
    struct refocus_disparity map = refocus_disparity16(NULL, width, height, stride);

    map.bits = 8;
    map.samples = samples;
    return map;
}

/** refocus_struct_read() of a map, for libraries that take one; its size alone is checked. */
static inline int refocus_disparity_read(struct refocus_disparity *own,
                                         const struct refocus_disparity *given)
{
    return refocus_struct_read(own, sizeof *own, REFOCUS_SIZE_TO(struct refocus_disparity, stride),
                               given);
}

#ifdef __cplusplus
}
#endif
#endif
