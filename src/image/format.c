/* format.c: sizes and checks of pictures and maps in every format. */
#include "image/format.h"

enum { PLANES = 3 };

/* The planes of each format: bytes for each pair of columns, and rows to one of its own, as a
 * shift. */
static const struct layout {
    int planes;
    struct {
        int pair, down;
    } plane[PLANES];
    int bytes; /* a sample has so many */
} layouts[] = {
    [REFOCUS_FORMAT_NV12] = {2, {{0, 0}, {2, 1}}, 1},
    [REFOCUS_FORMAT_NV21] = {2, {{0, 0}, {2, 1}}, 1},
    [REFOCUS_FORMAT_I420] = {3, {{0, 0}, {1, 1}, {1, 1}}, 1},
    [REFOCUS_FORMAT_YUYV] = {1, {{4, 0}}, 1},
    [REFOCUS_FORMAT_P010] = {2, {{0, 0}, {4, 1}}, 2},
    [REFOCUS_FORMAT_P016] = {2, {{0, 0}, {4, 1}}, 2},
};

int refocus_format_bytes(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
    case REFOCUS_FORMAT_BGR8:
        return 3;
    case REFOCUS_FORMAT_RGBA8:
    case REFOCUS_FORMAT_BGRA8:
        return 4;
    case REFOCUS_FORMAT_RGB16:
    case REFOCUS_FORMAT_RGB_HALF:
        return 6;
    case REFOCUS_FORMAT_RGBA16:
    case REFOCUS_FORMAT_RGBA_HALF:
        return 8;
    case REFOCUS_FORMAT_RGB_FLOAT:
        return 12;
    case REFOCUS_FORMAT_RGBA_FLOAT:
        return 16;
    }
    return 0;
}

int refocus_format_is_yuv(uint32_t format)
{
    return format < sizeof layouts / sizeof *layouts && layouts[format].planes > 0;
}

int refocus_format_planes(uint32_t format)
{
    if (refocus_format_bytes(format))
        return 1;
    return refocus_format_is_yuv(format) ? layouts[format].planes : 0;
}

ptrdiff_t refocus_plane_row_bytes(uint32_t format, int plane, int32_t width)
{
    if (plane < 0 || plane >= refocus_format_planes(format) || width < 1 ||
        width > REFOCUS_MAX_SIDE)
        return 0;
    if (refocus_format_bytes(format))
        return (ptrdiff_t)width * refocus_format_bytes(format);
    if (layouts[format].plane[plane].pair)
        return ((ptrdiff_t)width + 1) / 2 * layouts[format].plane[plane].pair;
    return (ptrdiff_t)width * layouts[format].bytes;
}

int32_t refocus_plane_rows(uint32_t format, int plane, int32_t height)
{
    if (plane < 0 || plane >= refocus_format_planes(format) || height < 1 ||
        height > REFOCUS_MAX_SIDE)
        return 0;
    if (refocus_format_is_yuv(format) && layouts[format].plane[plane].down)
        return height / 2 + height % 2;
    return height;
}
