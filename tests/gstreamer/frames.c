/* frames.c: frames of any format with a pattern, and the library's pictures of them. */
#include <stdbool.h>
#include <string.h>
#include "frames.h"
#include "plugin.h"

void bench_open(struct bench *bench, const char *video_caps, const char *depth_caps)
{
    memset(bench, 0, sizeof *bench);
    bench->element = gst_element_factory_make("refocus", NULL);
    g_assert(bench->element);
    bench->video = gst_harness_new_with_element(bench->element, "sink", "src");
    gst_harness_set_live(bench->video, FALSE);
    bench->bus = gst_bus_new();
    gst_element_set_bus(bench->element, bench->bus);
    if (depth_caps) {
        bench->depth = gst_harness_new_with_element(bench->element, "depth", NULL);
        gst_harness_set_live(bench->depth, FALSE);
        gst_harness_set_src_caps_str(bench->depth, depth_caps);
    }
    gst_harness_set_src_caps_str(bench->video, video_caps);
}

void bench_close(struct bench *bench)
{
    gst_element_set_bus(bench->element, NULL);
    gst_object_unref(bench->bus);
    if (bench->depth)
        gst_harness_teardown(bench->depth);
    gst_harness_teardown(bench->video);
    gst_object_unref(bench->element);
}

char *bench_error(struct bench *bench)
{
    GstMessage *const message =
        gst_bus_timed_pop_filtered(bench->bus, 5 * GST_SECOND, GST_MESSAGE_ERROR);
    GError *error = NULL;
    char *text;

    if (!message)
        return NULL;
    gst_message_parse_error(message, &error, NULL);
    text = g_strdup(error->message);
    g_error_free(error);
    gst_message_unref(message);
    return text;
}

static void info_of(const char *text, GstVideoInfo *info)
{
    GstCaps *const caps = gst_caps_from_string(text);

    g_assert(gst_video_info_from_caps(info, caps));
    gst_caps_unref(caps);
}

static GstBuffer *new_buffer(const GstVideoInfo *info, GstClockTime time)
{
    GstBuffer *const buffer = gst_buffer_new_allocate(NULL, GST_VIDEO_INFO_SIZE(info), NULL);

    gst_buffer_memset(buffer, 0, 0, GST_VIDEO_INFO_SIZE(info));
    GST_BUFFER_PTS(buffer) = time;
    GST_BUFFER_DURATION(buffer) = 40 * GST_MSECOND;
    return buffer;
}

/* Blocks of 8 bytes and rows with a step between them: smooth, with edges. */
static uint8_t pattern(unsigned seed, int plane, int x, int y)
{
    return (uint8_t)(seed * 31 + (unsigned)plane * 70 + (unsigned)(x / 8 * 37 + y / 6 * 59) % 160 +
                     40);
}

static void fill(const char *caps, GstBuffer *buffer, unsigned seed, int flat)
{
    GstVideoFrame frame;
    GstVideoInfo info;

    info_of(caps, &info);
    g_assert(gst_video_frame_map(&frame, &info, buffer, GST_MAP_WRITE));
    for (guint p = 0; p < GST_VIDEO_FRAME_N_PLANES(&frame); p++) {
        const int stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, p);
        const int rows = GST_VIDEO_FRAME_COMP_HEIGHT(&frame, p);
        uint8_t *const data = GST_VIDEO_FRAME_PLANE_DATA(&frame, p);

        for (int y = 0; y < rows; y++)
            for (int x = 0; x < stride; x++)
                data[y * stride + x] = flat >= 0 ? (uint8_t)flat : pattern(seed, (int)p, x, y);
    }
    gst_video_frame_unmap(&frame);
}

GstBuffer *frame_make(const char *caps, unsigned seed, GstClockTime time)
{
    GstVideoInfo info;
    GstBuffer *buffer;

    info_of(caps, &info);
    buffer = new_buffer(&info, time);
    fill(caps, buffer, seed, -1);
    return buffer;
}

GstBuffer *frame_flat(const char *caps, int value, GstClockTime time)
{
    GstBuffer *const buffer = frame_make(caps, 0, time);

    fill(caps, buffer, 0, value);
    return buffer;
}

struct refocus_settings frame_settings(double focus, double blur)
{
    struct refocus_settings settings = refocus_settings_default((float)focus, (float)blur);

    settings.highlights.estimate = 1;
    return settings;
}

/* By the names of GStreamer and the library, not by the element's own table. */
static uint32_t format_named(const char *name)
{
    static const struct {
        const char *name;
        uint32_t format;
    } names[] = {{"NV12", REFOCUS_FORMAT_NV12},     {"NV21", REFOCUS_FORMAT_NV21},
                 {"I420", REFOCUS_FORMAT_I420},     {"YV12", REFOCUS_FORMAT_I420},
                 {"YUY2", REFOCUS_FORMAT_YUYV},     {"GRAY8", REFOCUS_FORMAT_I420},
                 {"RGB", REFOCUS_FORMAT_RGB8},      {"BGR", REFOCUS_FORMAT_BGR8},
                 {"RGBA", REFOCUS_FORMAT_RGBA8},    {"BGRA", REFOCUS_FORMAT_BGRA8},
                 {"RGBx", REFOCUS_FORMAT_RGBA8},    {"BGRx", REFOCUS_FORMAT_BGRA8},
                 {"P010_10LE", REFOCUS_FORMAT_P010}};

    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (strcmp(names[i].name, name) == 0)
            return names[i].format;
    return REFOCUS_FORMAT_NONE;
}

static struct refocus_image image_of(const GstVideoFrame *frame, uint8_t *chroma)
{
    const char *name = gst_video_format_to_string(GST_VIDEO_FRAME_FORMAT(frame));
    const bool swapped = strcmp(name, "YV12") == 0;
    struct refocus_image image = refocus_image_packed(
        format_named(name), NULL, GST_VIDEO_FRAME_WIDTH(frame), GST_VIDEO_FRAME_HEIGHT(frame), 0);

    for (guint i = 0; i < GST_VIDEO_FRAME_N_PLANES(frame); i++) {
        image.plane[swapped && i ? 3 - i : i] = GST_VIDEO_FRAME_PLANE_DATA(frame, i);
        image.stride[swapped && i ? 3 - i : i] = GST_VIDEO_FRAME_PLANE_STRIDE(frame, i);
    }
    if (frame->info.colorimetry.range == GST_VIDEO_COLOR_RANGE_0_255)
        image.range = REFOCUS_RANGE_FULL;
    if (frame->info.colorimetry.matrix == GST_VIDEO_COLOR_MATRIX_BT709 ||
        frame->info.colorimetry.matrix == GST_VIDEO_COLOR_MATRIX_BT2020)
        image.matrix = REFOCUS_MATRIX_BT709;
    if (strcmp(name, "GRAY8") == 0) {
        image.plane[1] = image.plane[2] = chroma;
        image.stride[1] = image.stride[2] = image.width;
        if (frame->info.colorimetry.range != GST_VIDEO_COLOR_RANGE_16_235)
            image.range = REFOCUS_RANGE_FULL;
    }
    switch (frame->info.colorimetry.transfer) {
    case GST_VIDEO_TRANSFER_SMPTE2084:
        image.transfer = REFOCUS_TRANSFER_PQ;
        image.matrix = REFOCUS_MATRIX_BT2020;
        break;
    case GST_VIDEO_TRANSFER_ARIB_STD_B67:
        image.transfer = REFOCUS_TRANSFER_HLG;
        image.matrix = REFOCUS_MATRIX_BT2020;
        break;
    default:
        break;
    }
    return image;
}

GstBuffer *frame_expect(const char *caps, GstBuffer *frame, const struct refocus_disparity *map,
                        struct refocus_settings *settings)
{
    struct refocus_renderer_params params;
    struct refocus_renderer *renderer;
    struct refocus_image photo, out;
    GstVideoFrame in, result;
    uint8_t *chroma;
    GstVideoInfo info;
    GstBuffer *buffer;

    info_of(caps, &info);
    chroma = g_malloc(GST_VIDEO_INFO_SIZE(&info));
    memset(chroma, 128, GST_VIDEO_INFO_SIZE(&info));
    buffer = new_buffer(&info, GST_BUFFER_PTS(frame));
    g_assert(gst_video_frame_map(&in, &info, frame, GST_MAP_READ));
    g_assert(gst_video_frame_map(&result, &info, buffer, GST_MAP_WRITE));
    photo = image_of(&in, chroma);
    out = image_of(&result, chroma);
    /* The element makes its renderer for 40 pixels at the least, and upsampled disparities depend
     * on that number. */
    params = refocus_renderer_params_default(photo.width, photo.height, 40);
    params.threads = 1;
    params.deep = photo.format == REFOCUS_FORMAT_P010;
    g_assert(refocus_renderer_create(&renderer, &params) == REFOCUS_OK);
    g_assert(refocus_prepare(renderer, &photo, map) == REFOCUS_OK);
    g_assert(refocus_render_settings(renderer, settings, &out) == REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    gst_video_frame_unmap(&in);
    gst_video_frame_unmap(&result);
    g_free(chroma);
    return buffer;
}

gboolean frame_same(const char *caps, GstBuffer *a, GstBuffer *b)
{
    GstVideoFrame fa, fb;
    GstVideoInfo info;
    gboolean same = TRUE;

    info_of(caps, &info);
    g_assert(gst_video_frame_map(&fa, &info, a, GST_MAP_READ));
    g_assert(gst_video_frame_map(&fb, &info, b, GST_MAP_READ));
    for (guint i = 0; i < GST_VIDEO_FRAME_N_PLANES(&fa); i++) {
        const int bytes = GST_VIDEO_FRAME_COMP_WIDTH(&fa, i) * GST_VIDEO_FRAME_COMP_PSTRIDE(&fa, i);

        for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&fa, i); y++)
            same = same && memcmp((uint8_t *)GST_VIDEO_FRAME_PLANE_DATA(&fa, i) +
                                      y * GST_VIDEO_FRAME_PLANE_STRIDE(&fa, i),
                                  (uint8_t *)GST_VIDEO_FRAME_PLANE_DATA(&fb, i) +
                                      y * GST_VIDEO_FRAME_PLANE_STRIDE(&fb, i),
                                  (size_t)bytes) == 0;
    }
    gst_video_frame_unmap(&fa);
    gst_video_frame_unmap(&fb);
    return same;
}
