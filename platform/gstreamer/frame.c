/* frame.c: frames of GStreamer are described to the library where they lie. */
#include <stdlib.h>
#include <string.h>
#include "frame.h"

static uint32_t format_of(GstVideoFormat format)
{
    switch (format) {
    case GST_VIDEO_FORMAT_NV12:
        return REFOCUS_FORMAT_NV12;
    case GST_VIDEO_FORMAT_NV21:
        return REFOCUS_FORMAT_NV21;
    case GST_VIDEO_FORMAT_I420:
    case GST_VIDEO_FORMAT_YV12:
    case GST_VIDEO_FORMAT_GRAY8:
        return REFOCUS_FORMAT_I420;
    case GST_VIDEO_FORMAT_YUY2:
        return REFOCUS_FORMAT_YUYV;
    case GST_VIDEO_FORMAT_RGB:
        return REFOCUS_FORMAT_RGB8;
    case GST_VIDEO_FORMAT_BGR:
        return REFOCUS_FORMAT_BGR8;
    case GST_VIDEO_FORMAT_RGBA:
    case GST_VIDEO_FORMAT_RGBx: /* the fourth byte goes through as alpha does */
        return REFOCUS_FORMAT_RGBA8;
    case GST_VIDEO_FORMAT_BGRA:
    case GST_VIDEO_FORMAT_BGRx:
        return REFOCUS_FORMAT_BGRA8;
    case GST_VIDEO_FORMAT_P010_10LE:
    case GST_VIDEO_FORMAT_P010_10BE:
        return REFOCUS_FORMAT_P010;
    default:
        return REFOCUS_FORMAT_NONE;
    }
}

/* Curves of standards for a dim room are taken for sRGB's, as those of 8 bits are. */
static uint32_t transfer_of(GstVideoTransferFunction transfer)
{
    switch (transfer) {
    case GST_VIDEO_TRANSFER_SMPTE2084:
        return REFOCUS_TRANSFER_PQ;
    case GST_VIDEO_TRANSFER_ARIB_STD_B67:
        return REFOCUS_TRANSFER_HLG;
    case GST_VIDEO_TRANSFER_GAMMA10:
        return REFOCUS_TRANSFER_LINEAR;
    default:
        return REFOCUS_TRANSFER_SRGB;
    }
}

/* Whether a plane lies in the memory that was mapped for it. Of a buffer with metadata that is a
 * map of each plane, of others one of them all. */
static bool fits(const GstVideoFrame *frame, guint plane)
{
    const GstMapInfo *const map = &frame->map[frame->meta ? plane : 0];
    const GstVideoFormatInfo *const format = frame->info.finfo;
    const gint stride = GST_VIDEO_FRAME_PLANE_STRIDE(frame, plane);
    const guint8 *const data = GST_VIDEO_FRAME_PLANE_DATA(frame, plane);
    gint component[GST_VIDEO_MAX_COMPONENTS];
    guint64 row, rows;

    gst_video_format_info_component(format, plane, component);
    row = (guint64)GST_VIDEO_FORMAT_INFO_SCALE_WIDTH(format, component[0],
                                                     GST_VIDEO_FRAME_WIDTH(frame)) *
          (guint64)GST_VIDEO_FORMAT_INFO_PSTRIDE(format, component[0]);
    rows = (guint64)GST_VIDEO_FORMAT_INFO_SCALE_HEIGHT(format, component[0],
                                                       GST_VIDEO_FRAME_HEIGHT(frame));
    return stride > 0 && (guint64)stride >= row && data >= map->data &&
           (guint64)(data - map->data) + (rows - 1) * (guint64)stride + row <= map->size;
}

bool rf_gst_frame_map(GstVideoFrame *frame, const GstVideoInfo *info, GstBuffer *buffer,
                      GstMapFlags flags)
{
    bool good = gst_video_frame_map(frame, info, buffer, flags);

    if (!good)
        return false;
    good = GST_VIDEO_FRAME_WIDTH(frame) == GST_VIDEO_INFO_WIDTH(info) &&
           GST_VIDEO_FRAME_HEIGHT(frame) == GST_VIDEO_INFO_HEIGHT(info) &&
           GST_VIDEO_FRAME_FORMAT(frame) == GST_VIDEO_INFO_FORMAT(info);
    for (guint i = 0; good && i < GST_VIDEO_FRAME_N_PLANES(frame); i++)
        good = fits(frame, i);
    if (!good)
        gst_video_frame_unmap(frame);
    return good;
}

bool rf_gst_is_deep(const struct refocus_image *picture)
{
    return picture->format == REFOCUS_FORMAT_P010;
}

static bool add_chroma(struct rf_gst_chroma *chroma, struct refocus_image *picture)
{
    const size_t row = (size_t)refocus_plane_row_bytes(picture->format, 1, picture->width);
    const size_t bytes = row * (size_t)refocus_plane_rows(picture->format, 1, picture->height);

    if (bytes > chroma->bytes) {
        rf_gst_chroma_end(chroma);
        chroma->memory = malloc(bytes);
        if (!chroma->memory)
            return false;
        chroma->bytes = bytes;
    }
    memset(chroma->memory, 128, bytes);
    picture->plane[1] = picture->plane[2] = chroma->memory;
    picture->stride[1] = picture->stride[2] = (ptrdiff_t)row;
    return true;
}

bool rf_gst_picture(const GstVideoFrame *frame, struct rf_gst_chroma *chroma,
                    struct refocus_image *picture)
{
    const GstVideoColorimetry *const colour = &frame->info.colorimetry;
    const bool grey = GST_VIDEO_FRAME_FORMAT(frame) == GST_VIDEO_FORMAT_GRAY8;
    bool deep;

    *picture = refocus_image_packed(format_of(GST_VIDEO_FRAME_FORMAT(frame)), NULL,
                                    GST_VIDEO_FRAME_WIDTH(frame), GST_VIDEO_FRAME_HEIGHT(frame), 0);
    deep = rf_gst_is_deep(picture);
    for (guint i = 0; i < GST_VIDEO_FRAME_N_PLANES(frame); i++) {
        picture->plane[i] = GST_VIDEO_FRAME_PLANE_DATA(frame, i);
        picture->stride[i] = GST_VIDEO_FRAME_PLANE_STRIDE(frame, i);
    }
    if (GST_VIDEO_FRAME_FORMAT(frame) == GST_VIDEO_FORMAT_YV12) {
        picture->plane[1] = GST_VIDEO_FRAME_COMP_DATA(frame, 1);
        picture->plane[2] = GST_VIDEO_FRAME_COMP_DATA(frame, 2);
    }
    picture->matrix = REFOCUS_MATRIX_BT601;
    if (colour->matrix == GST_VIDEO_COLOR_MATRIX_BT709)
        picture->matrix = REFOCUS_MATRIX_BT709;
    else if (colour->matrix == GST_VIDEO_COLOR_MATRIX_BT2020) /* BT.709 is the nearest of 8 bits */
        picture->matrix = deep ? REFOCUS_MATRIX_BT2020 : REFOCUS_MATRIX_BT709;
    if (deep)
        picture->transfer = transfer_of(colour->transfer);
    picture->range = colour->range == GST_VIDEO_COLOR_RANGE_0_255 ||
                             (grey && colour->range != GST_VIDEO_COLOR_RANGE_16_235)
                         ? REFOCUS_RANGE_FULL
                         : REFOCUS_RANGE_LIMITED;
    return !grey || add_chroma(chroma, picture);
}

void rf_gst_chroma_end(struct rf_gst_chroma *chroma)
{
    free(chroma->memory);
    *chroma = (struct rf_gst_chroma){NULL, 0};
}
