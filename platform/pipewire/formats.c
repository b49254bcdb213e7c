/* formats.c: formats and buffers in the words of PipeWire. */
#include <math.h>
#include <spa/buffer/meta.h>
#include <spa/param/buffers.h>
#include <spa/param/video/format-utils.h>
#include "pipewire.h"

/* A source offers them in this order. */
static const struct {
    uint32_t ours, spa;
} formats[] = {
    {REFOCUS_FRAME_NV12, SPA_VIDEO_FORMAT_NV12},   {REFOCUS_FRAME_NV21, SPA_VIDEO_FORMAT_NV21},
    {REFOCUS_FRAME_YUV420, SPA_VIDEO_FORMAT_I420}, {REFOCUS_FRAME_YUYV, SPA_VIDEO_FORMAT_YUY2},
    {REFOCUS_FRAME_UYVY, SPA_VIDEO_FORMAT_UYVY},   {REFOCUS_FRAME_RGB24, SPA_VIDEO_FORMAT_RGB},
    {REFOCUS_FRAME_BGR24, SPA_VIDEO_FORMAT_BGR},   {REFOCUS_FRAME_RGBX, SPA_VIDEO_FORMAT_RGBx},
    {REFOCUS_FRAME_BGRX, SPA_VIDEO_FORMAT_BGRx},   {REFOCUS_FRAME_RGBX, SPA_VIDEO_FORMAT_RGBA},
    {REFOCUS_FRAME_BGRX, SPA_VIDEO_FORMAT_BGRA},   {REFOCUS_FRAME_Y16, SPA_VIDEO_FORMAT_GRAY16_LE},
    {REFOCUS_FRAME_GREY, SPA_VIDEO_FORMAT_GRAY8},
};
enum { FORMATS = sizeof formats / sizeof *formats };

static uint32_t spa_of(uint32_t format)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].ours == format)
            return formats[i].spa;
    return SPA_VIDEO_FORMAT_UNKNOWN;
}

uint32_t rf_pipewire_format_of(uint32_t spa)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].spa == spa)
            return formats[i].ours;
    return REFOCUS_FRAME_ANY;
}

static bool is_side(uint32_t side)
{
    return side >= 1 && side <= REFOCUS_MAX_SIDE;
}

struct rf_pipewire_format rf_pipewire_read_format(const struct spa_pod *pod)
{
    struct rf_pipewire_format format = {.format = REFOCUS_FRAME_ANY};
    struct spa_rectangle size = {0, 0};
    struct spa_fraction rate = {0, 0};
    uint32_t type, subtype;

    if (spa_format_parse(pod, &type, &subtype) < 0 || type != SPA_MEDIA_TYPE_video)
        return format;
    if (subtype == SPA_MEDIA_SUBTYPE_raw) {
        struct spa_video_info_raw raw;

        spa_zero(raw);
        if (spa_format_video_raw_parse(pod, &raw) < 0)
            return format;
        size = raw.size;
        rate = raw.framerate;
        format.format = rf_pipewire_format_of(raw.format);
        if (raw.color_matrix == SPA_VIDEO_COLOR_MATRIX_BT709)
            format.matrix = REFOCUS_MATRIX_BT709;
        format.full_range = raw.color_range == SPA_VIDEO_COLOR_RANGE_0_255;
    } else if (subtype == SPA_MEDIA_SUBTYPE_mjpg) {
        struct spa_video_info_mjpg jpeg;

        spa_zero(jpeg);
        if (spa_format_video_mjpg_parse(pod, &jpeg) < 0)
            return format;
        size = jpeg.size;
        rate = jpeg.framerate;
        format.format = REFOCUS_FRAME_MJPEG;
    }
    if (!is_side(size.width) || !is_side(size.height))
        format.format = REFOCUS_FRAME_ANY;
    format.width = (int)size.width;
    format.height = (int)size.height;
    format.fps = rate.denom ? (double)rate.num / rate.denom : 0;
    return format;
}

static struct spa_fraction fraction(double fps)
{
    return fps == floor(fps) ? SPA_FRACTION((uint32_t)fps, 1)
                             : SPA_FRACTION((uint32_t)(fps * 1000 + 0.5), 1000);
}

/* Any size, or that one; the wanted one is the nearest in either case. */
static const struct spa_pod *wish(struct spa_pod_builder *builder, uint32_t subtype,
                                  const struct refocus_source_config *config, bool exact)
{
    const struct spa_rectangle size =
        config->width > 0 && config->height > 0
            ? SPA_RECTANGLE((uint32_t)config->width, (uint32_t)config->height)
            : SPA_RECTANGLE(1280, 720);
    const struct spa_rectangle least = SPA_RECTANGLE(1, 1),
                               most = SPA_RECTANGLE(REFOCUS_MAX_SIDE, REFOCUS_MAX_SIDE);
    const struct spa_fraction rate = fraction(config->fps > 0 ? config->fps : 30),
                              slowest = SPA_FRACTION(0, 1), fastest = SPA_FRACTION(10000, 1);
    struct spa_pod_frame object, choice;

    spa_pod_builder_push_object(builder, &object, SPA_TYPE_OBJECT_Format, SPA_PARAM_EnumFormat);
    spa_pod_builder_add(builder, SPA_FORMAT_mediaType, SPA_POD_Id(SPA_MEDIA_TYPE_video),
                        SPA_FORMAT_mediaSubtype, SPA_POD_Id(subtype), 0);
    if (subtype == SPA_MEDIA_SUBTYPE_raw) {
        spa_pod_builder_prop(builder, SPA_FORMAT_VIDEO_format, 0);
        spa_pod_builder_push_choice(builder, &choice, SPA_CHOICE_Enum, 0);
        if (config->format != REFOCUS_FRAME_ANY) /* the first one is the default */
            spa_pod_builder_id(builder, spa_of(config->format));
        else
            spa_pod_builder_id(builder, formats[0].spa);
        for (int i = 0; i < FORMATS; i++)
            if (config->format == REFOCUS_FRAME_ANY || config->format == formats[i].ours)
                spa_pod_builder_id(builder, formats[i].spa);
        spa_pod_builder_pop(builder, &choice);
    }
    if (exact)
        spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_size, SPA_POD_Rectangle(&size), 0);
    else
        spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_size,
                            SPA_POD_CHOICE_RANGE_Rectangle(&size, &least, &most), 0);
    spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_framerate,
                        SPA_POD_CHOICE_RANGE_Fraction(&rate, &slowest, &fastest), 0);
    return spa_pod_builder_pop(builder, &object);
}

int rf_pipewire_offer_wishes(struct spa_pod_builder *builder, const struct spa_pod *pods[4],
                             const struct refocus_source_config *config)
{
    const bool sized = config->width > 0 && config->height > 0;
    int n = 0;

    for (int exact = sized; exact >= 0; exact--) {
        if (config->format != REFOCUS_FRAME_MJPEG)
            pods[n++] = wish(builder, SPA_MEDIA_SUBTYPE_raw, config, exact);
        if (config->format == REFOCUS_FRAME_ANY || config->format == REFOCUS_FRAME_MJPEG)
            pods[n++] = wish(builder, SPA_MEDIA_SUBTYPE_mjpg, config, exact);
    }
    return n;
}

const struct spa_pod *rf_pipewire_offer(struct spa_pod_builder *builder,
                                        const struct rf_pipewire_format *format)
{
    const struct spa_rectangle size =
        SPA_RECTANGLE((uint32_t)format->width, (uint32_t)format->height);
    const struct spa_fraction rate = fraction(format->fps);
    struct spa_pod_frame object;

    spa_pod_builder_push_object(builder, &object, SPA_TYPE_OBJECT_Format, SPA_PARAM_EnumFormat);
    spa_pod_builder_add(builder, SPA_FORMAT_mediaType, SPA_POD_Id(SPA_MEDIA_TYPE_video),
                        SPA_FORMAT_mediaSubtype, SPA_POD_Id(SPA_MEDIA_SUBTYPE_raw),
                        SPA_FORMAT_VIDEO_format, SPA_POD_Id(spa_of(format->format)),
                        SPA_FORMAT_VIDEO_size, SPA_POD_Rectangle(&size), SPA_FORMAT_VIDEO_framerate,
                        SPA_POD_Fraction(&rate), 0);
    if (format->format <= REFOCUS_FRAME_YUV420)
        spa_pod_builder_add(builder, SPA_FORMAT_VIDEO_colorRange,
                            SPA_POD_Id(format->full_range ? SPA_VIDEO_COLOR_RANGE_0_255
                                                          : SPA_VIDEO_COLOR_RANGE_16_235),
                            SPA_FORMAT_VIDEO_colorMatrix,
                            SPA_POD_Id(format->matrix == REFOCUS_MATRIX_BT709
                                           ? SPA_VIDEO_COLOR_MATRIX_BT709
                                           : SPA_VIDEO_COLOR_MATRIX_BT601),
                            0);
    return spa_pod_builder_pop(builder, &object);
}

void rf_pipewire_offer_buffers(struct spa_pod_builder *builder, const struct spa_pod *pods[2],
                               int count, uint64_t bytes, int64_t stride, uint32_t types)
{
    struct spa_pod_frame object;

    spa_pod_builder_push_object(builder, &object, SPA_TYPE_OBJECT_ParamBuffers, SPA_PARAM_Buffers);
    spa_pod_builder_add(builder, SPA_PARAM_BUFFERS_buffers,
                        SPA_POD_CHOICE_RANGE_Int(count, 2, RF_MOST_BUFFERS / 2),
                        SPA_PARAM_BUFFERS_dataType, SPA_POD_CHOICE_FLAGS_Int(types), 0);
    if (bytes)
        spa_pod_builder_add(builder, SPA_PARAM_BUFFERS_blocks, SPA_POD_Int(1),
                            SPA_PARAM_BUFFERS_size, SPA_POD_Int((int)bytes),
                            SPA_PARAM_BUFFERS_stride, SPA_POD_Int((int)stride), 0);
    pods[0] = spa_pod_builder_pop(builder, &object);
    pods[1] = spa_pod_builder_add_object(builder, SPA_TYPE_OBJECT_ParamMeta, SPA_PARAM_Meta,
                                         SPA_PARAM_META_type, SPA_POD_Id(SPA_META_Header),
                                         SPA_PARAM_META_size,
                                         SPA_POD_Int(sizeof(struct spa_meta_header)));
}
