/* layout.c: how frames lie in memory, by their format. */
#include "../file/letters.h"
#include "layout.h"

static const struct {
    const char *name;
    int planes;
    int bits; /* bits that a pixel takes in plane 0 */
} formats[REFOCUS_FRAME_FORMAT_COUNT] = {
    [REFOCUS_FRAME_ANY] = {NULL, 0, 0},       [REFOCUS_FRAME_YUYV] = {"YUYV", 1, 16},
    [REFOCUS_FRAME_UYVY] = {"UYVY", 1, 16},   [REFOCUS_FRAME_NV12] = {"NV12", 2, 8},
    [REFOCUS_FRAME_NV21] = {"NV21", 2, 8},    [REFOCUS_FRAME_YUV420] = {"YUV420", 3, 8},
    [REFOCUS_FRAME_RGB24] = {"RGB24", 1, 24}, [REFOCUS_FRAME_BGR24] = {"BGR24", 1, 24},
    [REFOCUS_FRAME_RGBX] = {"RGBX", 1, 32},   [REFOCUS_FRAME_BGRX] = {"BGRX", 1, 32},
    [REFOCUS_FRAME_MJPEG] = {"MJPEG", 1, 0},  [REFOCUS_FRAME_GREY] = {"GREY", 1, 8},
    [REFOCUS_FRAME_Y16] = {"Y16", 1, 16},     [REFOCUS_FRAME_Z16] = {"Z16", 1, 16},
};

const char *refocus_frame_format_name(uint32_t format)
{
    return format < REFOCUS_FRAME_FORMAT_COUNT ? formats[format].name : NULL;
}

uint32_t rf_format_by_name(const char *name)
{
    for (uint32_t i = 1; i < REFOCUS_FRAME_FORMAT_COUNT; i++)
        if (rf_same_word(formats[i].name, name))
            return i;
    return REFOCUS_FRAME_ANY;
}

int rf_format_planes(uint32_t format)
{
    return format < REFOCUS_FRAME_FORMAT_COUNT ? formats[format].planes : 0;
}

int64_t rf_plane_row(uint32_t format, int plane, int width)
{
    const int64_t pairs = ((int64_t)width + 1) / 2;

    if (plane >= rf_format_planes(format))
        return 0;
    if (format == REFOCUS_FRAME_YUYV || format == REFOCUS_FRAME_UYVY)
        return pairs * 4;
    if (plane == 0)
        return (int64_t)width * formats[format].bits / 8;
    return format == REFOCUS_FRAME_YUV420 ? pairs : pairs * 2;
}

int rf_plane_rows(uint32_t format, int plane, int height)
{
    (void)format;
    return plane == 0 ? height : (height + 1) / 2;
}

bool rf_stride_fits(ptrdiff_t stride, int64_t row, int rows)
{
    const ptrdiff_t most = PTRDIFF_MAX / (rows > 0 ? rows : 1);

    return (stride >= row && stride <= most) || (stride <= -row && stride >= -most);
}

int64_t rf_plane_stride(uint32_t format, int plane, int64_t stride)
{
    if (plane == 0)
        return stride;
    return format == REFOCUS_FRAME_YUV420 ? (stride + 1) / 2 : (stride + 1) / 2 * 2;
}

uint64_t rf_frame_bytes(uint32_t format, int64_t stride, int width, int height)
{
    uint64_t bytes = 0;

    if (width < 1 || height < 1 || width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE ||
        stride < rf_plane_row(format, 0, width) || stride > (int64_t)1 << 24)
        return 0;
    for (int i = 0; i < rf_format_planes(format); i++)
        bytes += (uint64_t)rf_plane_stride(format, i, stride) *
                 (uint64_t)rf_plane_rows(format, i, height);
    return bytes;
}

void rf_frame_lay_out(struct refocus_frame *frame, const uint8_t *memory, int64_t stride)
{
    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        frame->plane[i] = memory;
        frame->stride[i] = (ptrdiff_t)rf_plane_stride(frame->format, i, stride);
        memory += frame->stride[i] * rf_plane_rows(frame->format, i, frame->height);
    }
}

uint32_t rf_matrix_by_size(int width, int height)
{
    return width >= 1280 || height > 576 ? REFOCUS_MATRIX_BT709 : REFOCUS_MATRIX_BT601;
}
