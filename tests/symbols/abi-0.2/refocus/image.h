/* image.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
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
enum refocus_format {
    REFOCUS_FORMAT_NONE = 0,
    REFOCUS_FORMAT_RGB8 = 1,
    REFOCUS_FORMAT_BGR8 = 2,
    REFOCUS_FORMAT_RGBA8 = 3,
    REFOCUS_FORMAT_BGRA8 = 4,
    REFOCUS_FORMAT_NV12 = 5,
    REFOCUS_FORMAT_NV21 = 6,
    REFOCUS_FORMAT_I420 = 7,
    REFOCUS_FORMAT_YUYV = 8,
};
enum refocus_matrix {
    REFOCUS_MATRIX_BT601 = 0,
    REFOCUS_MATRIX_BT709 = 1,
};
enum refocus_range {
    REFOCUS_RANGE_LIMITED = 0,
    REFOCUS_RANGE_FULL = 1,
};
enum { REFOCUS_MAX_SIDE = 65535 };
struct refocus_image {
    uint32_t struct_size;
    uint32_t format;
    int32_t width;
    int32_t height;
    uint8_t *plane[3];
    ptrdiff_t stride[3];
    uint32_t matrix;
    uint32_t range;
};
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
static inline int refocus_image_read(struct refocus_image *own, const struct refocus_image *given)
{
    return refocus_struct_read(own, sizeof *own, REFOCUS_SIZE_TO(struct refocus_image, range),
                               given);
}
REFOCUS_API int refocus_format_bytes(uint32_t format);
REFOCUS_API int refocus_format_is_yuv(uint32_t format);
REFOCUS_API int refocus_format_planes(uint32_t format);
REFOCUS_API ptrdiff_t refocus_plane_row_bytes(uint32_t format, int plane, int32_t width);
REFOCUS_API int32_t refocus_plane_rows(uint32_t format, int plane, int32_t height);
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
static inline uint64_t refocus_image_bytes(uint32_t format, int32_t width, int32_t height)
{
    uint64_t bytes = 0;
    int plane;
    for (plane = 0; plane < refocus_format_planes(format); plane++)
        bytes += (uint64_t)refocus_plane_row_bytes(format, plane, width) *
                 (uint64_t)refocus_plane_rows(format, plane, height);
    return bytes;
}
struct refocus_disparity {
    uint32_t struct_size;
    uint32_t bits;
    int32_t width;
    int32_t height;
    const void *samples;
    ptrdiff_t stride;
};
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
static inline struct refocus_disparity refocus_disparity8(const uint8_t *samples, int32_t width,
                                                          int32_t height, ptrdiff_t stride)
{
    struct refocus_disparity map = refocus_disparity16(NULL, width, height, stride);
    map.bits = 8;
    map.samples = samples;
    return map;
}
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
