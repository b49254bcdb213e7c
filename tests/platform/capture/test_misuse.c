/* test_misuse.c: callers give what none should: NULL, strides that memory has no room for. Each
 * function of the capture headers answers with a status, or does nothing, and writes nowhere. */
#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>

enum { W = 16, H = 12 };
static uint8_t memory[W * H * 4];
static const ptrdiff_t no_strides[] = {
    0, 1, -1, W - 1, -(W - 1), PTRDIFF_MIN, PTRDIFF_MAX, PTRDIFF_MIN + 1, PTRDIFF_MIN / 2};
enum { NO_STRIDES = sizeof no_strides / sizeof *no_strides };

/* Enough for the rows of U and V of 4:2:0 in planes, which have half as many. */
static bool is_half(ptrdiff_t stride)
{
    return stride == W - 1 || stride == 1 - W;
}

TEST(sources_of_nothing)
{
    const struct refocus_source_counters zeros = refocus_source_counters_default();
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_source_counters counters;
    struct refocus_source *source = NULL;
    struct refocus_source_mode mode = refocus_source_mode_default();
    const struct refocus_frame *frame;

    const struct refocus_source_config config = refocus_source_config_default();

    assert_string_not_equal(refocus_source_backends(), "");
    assert_int_equal(config.struct_size, sizeof config);
    memset(&counters, 7, sizeof counters);
    counters.struct_size = sizeof counters;
    refocus_source_get_counters(NULL, &counters);
    assert_memory_equal(&counters, &zeros, sizeof zeros);
    refocus_source_get_counters(NULL, NULL);
    assert_status(refocus_source_open(NULL, "replay:", NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_open(&source, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_get_mode(NULL, 0, &mode), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_start(NULL, NULL, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_restart(NULL, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_wait(NULL, 0, &frame, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_control(NULL, "focus", 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_get_lens(NULL, &lens, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_focus(NULL, 0, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_lock_exposure(NULL, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_list(NULL, NULL), REFOCUS_ERR_ARGUMENT);
    refocus_source_close(NULL);
    refocus_source_close(&source);
    refocus_source_stop(NULL);
    refocus_source_interrupt(NULL);
    refocus_source_release(NULL, NULL);
    assert_null(refocus_frame_format_name(UINT32_MAX));
    assert_int_equal(refocus_source_kind(NULL), REFOCUS_SOURCE_KIND_NONE);
    assert_int_equal(refocus_source_kind("nothing:0"), REFOCUS_SOURCE_KIND_NONE);
    assert_int_equal(refocus_source_kind("libcamera:0"), REFOCUS_SOURCE_KIND_CAMERA);

    source = started("replay::size 16x12;frames 2", REFOCUS_SOURCE_FAST);
    refocus_source_get_counters(source, NULL);
    assert_status(refocus_source_get_mode(source, 0, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_get_mode(source, -1, &mode), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_wait(source, 0, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_control(source, NULL, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_get_lens(source, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_focus(source, UINT32_MAX, 1, NULL), REFOCUS_ERR_ARGUMENT);
    for (int i = 0; i < 3; i++)
        assert_status(refocus_source_set_control(
                          source, "focus", (double[]){(double)NAN, 1e300, -INFINITY}[i], NULL),
                      REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_wait(source, -1, &frame, NULL), REFOCUS_OK);
    refocus_source_release(source, NULL);
    refocus_source_release(source, frame);
    refocus_source_release(source, frame); /* once is enough */
    refocus_source_get_counters(source, &counters);
    assert_true(counters.frames == 1 && counters.released == 1);
    refocus_source_close(&source);
}

/* Each number of what is wanted by itself out of its range. */
TEST(wishes_out_of_range)
{
    struct refocus_source *source = NULL;
    const struct refocus_source_config good = refocus_source_config_default();
    struct refocus_source_config bad[12];

    for (int i = 0; i < 12; i++)
        bad[i] = good;
    bad[0].format = REFOCUS_FRAME_FORMAT_COUNT;
    bad[1].width = -1;
    bad[2].width = REFOCUS_MAX_SIDE + 1;
    bad[3].height = -1;
    bad[4].height = REFOCUS_MAX_SIDE + 1;
    bad[5].fps = -1;
    bad[6].fps = (double)NAN;
    bad[7].buffers = 1;
    bad[8].flags = 16;
    bad[9].default_fps = -1;
    bad[10].default_fps = (double)NAN;
    bad[11].default_fps = 10001;
    assert_status(refocus_source_open(&source, "replay::size 16x12", NULL), REFOCUS_OK);
    for (int i = 0; i < 12; i++)
        assert_status(refocus_source_start(source, &bad[i], NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_start(source, &good, NULL, NULL), REFOCUS_OK);
    refocus_source_close(&source);
}

TEST(sinks_of_nothing)
{
    static const uint32_t formats[] = {REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_NV12,
                                       REFOCUS_FORMAT_NV21, REFOCUS_FORMAT_I420,
                                       REFOCUS_FORMAT_YUYV};
    struct refocus_sink *sink = NULL;
    struct refocus_image image = refocus_image_planar(REFOCUS_FORMAT_RGB8, memory, W, H);
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_reason reason;

    assert_status(refocus_sink_open(NULL, "null", NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_open(&sink, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_start(NULL, W, H, 30, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_start_image(NULL, &image, 30, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_write(NULL, &image, NULL), REFOCUS_ERR_STATE);
    assert_status(refocus_sink_close(NULL, NULL), REFOCUS_OK);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    assert_int_equal(refocus_sink_takes(NULL, REFOCUS_FORMAT_RGB8), 0);
    for (int i = 0; i < 5; i++) {
        const int32_t wrong[5][3] = {{-1, 1, 0}, {1, -1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 4}};

        mode.pixel_aspect[0] = wrong[i][0];
        mode.pixel_aspect[1] = wrong[i][1];
        mode.chroma_place = (uint32_t)wrong[i][2];
        assert_status(refocus_sink_open(&sink, "null", NULL), REFOCUS_OK);
        assert_status(refocus_sink_set_mode(sink, &mode), REFOCUS_ERR_ARGUMENT);
        assert_status(refocus_sink_set_mode(sink, NULL), REFOCUS_ERR_ARGUMENT);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    }
    mode = refocus_source_mode_default();
    assert_status(refocus_sink_set_mode(NULL, &mode), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_set_cancelled(NULL, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_sink_overwrites(NULL, "x"), 0);
    assert_int_equal(refocus_sink_overwrites("y4m:x", NULL), 0);
    assert_status(refocus_sink_open(&sink, "null", NULL), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, 0, H, 30, &reason), REFOCUS_ERR_ARGUMENT);
    assert_string_not_equal(reason.text, "");
    assert_status(refocus_sink_start_image(sink, NULL, 30, &reason), REFOCUS_ERR_ARGUMENT);
    assert_string_not_equal(reason.text, "");
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    for (int f = 0; f < 5; f++) {
        assert_status(refocus_sink_open(&sink, "raw:misuse.raw,own", NULL), REFOCUS_OK);
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_STATE);
        assert_status(refocus_sink_start_image(sink, NULL, 30, NULL), REFOCUS_ERR_ARGUMENT);
        image = refocus_image_planar(formats[f], memory, W, H);
        assert_status(refocus_sink_start_image(sink, &image, (double)INFINITY, NULL), REFOCUS_OK);
        assert_status(refocus_sink_write(sink, NULL, NULL), REFOCUS_ERR_ARGUMENT);
        for (int p = 0; p < refocus_format_planes(formats[f]); p++) {
            struct refocus_image bad = image;

            bad.plane[p] = NULL;
            assert_status(refocus_sink_write(sink, &bad, NULL), REFOCUS_ERR_ARGUMENT);
            bad.plane[p] = image.plane[p];
            for (int i = 0; i < NO_STRIDES; i++) {
                if (formats[f] == REFOCUS_FORMAT_I420 && p > 0 && is_half(no_strides[i]))
                    continue;
                bad.stride[p] = no_strides[i];
                assert_status(refocus_sink_write(sink, &bad, NULL), REFOCUS_ERR_ARGUMENT);
            }
        }
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    }
    remove("misuse.raw");
}

/* A frame in the memory here, of any format but JPEG. */
static struct refocus_frame frame_of(uint32_t format)
{
    struct refocus_frame frame = refocus_frame_default();
    const int row = format == REFOCUS_FRAME_RGB24 || format == REFOCUS_FRAME_BGR24 ? 3 * W
                    : format == REFOCUS_FRAME_RGBX || format == REFOCUS_FRAME_BGRX ? 4 * W
                    : format == REFOCUS_FRAME_YUYV || format == REFOCUS_FRAME_UYVY ||
                            format == REFOCUS_FRAME_Y16 || format == REFOCUS_FRAME_Z16
                        ? 2 * W
                        : W;

    frame.format = format;
    frame.width = W;
    frame.height = H;
    for (int i = 0; i < 3; i++) {
        frame.plane[i] = memory;
        frame.stride[i] = row;
    }
    return frame;
}

static int planes_of(uint32_t format)
{
    return format == REFOCUS_FRAME_YUV420                                 ? 3
           : format == REFOCUS_FRAME_NV12 || format == REFOCUS_FRAME_NV21 ? 2
                                                                          : 1;
}

/* Call everything that converts, with this frame and into this memory. */
static void convert(struct refocus_converter *converter, const struct refocus_frame *frame,
                    struct refocus_image *rgb, struct refocus_image *copy, uint16_t *samples,
                    bool good)
{
    const bool grey = frame->format >= REFOCUS_FRAME_GREY;

    assert_status(refocus_convert_rgb8(converter, frame, rgb, NULL),
                  good ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
    if (refocus_frame_image_format(frame->format))
        assert_status(refocus_convert_copy(converter, frame, copy, NULL),
                      good ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
    if (grey)
        assert_status(refocus_convert_samples(converter, frame, samples, NULL),
                      good ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
}

TEST(converters_of_nothing)
{
    static uint8_t to[W * H * 4];
    static uint16_t samples[W * H];
    struct refocus_image rgb = refocus_image_planar(REFOCUS_FORMAT_RGB8, to, W, H);
    struct refocus_converter *converter = NULL;
    struct refocus_frame frame = frame_of(REFOCUS_FRAME_NV12);

    assert_status(refocus_converter_create(NULL), REFOCUS_ERR_ARGUMENT);
    refocus_converter_destroy(NULL);
    refocus_converter_destroy(&converter);
    convert(NULL, &frame, &rgb, &rgb, samples, false);
    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    assert_status(refocus_convert_rgb8(converter, NULL, &rgb, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_convert_copy(converter, NULL, &rgb, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_convert_samples(converter, NULL, samples, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_frame_image_format(UINT32_MAX), REFOCUS_FORMAT_NONE);
    assert_int_equal(refocus_convert_image_format(NULL, &frame), REFOCUS_FORMAT_NONE);
    assert_int_equal(refocus_convert_image_format(converter, NULL), REFOCUS_FORMAT_NONE);
    assert_int_equal(refocus_convert_image_format(converter, &frame), REFOCUS_FORMAT_NV12);
    for (uint32_t format = 1; format < REFOCUS_FRAME_FORMAT_COUNT; format++) {
        const uint32_t own = refocus_frame_image_format(format);
        struct refocus_image copy =
            refocus_image_planar(own ? own : (uint32_t)REFOCUS_FORMAT_RGB8, to, W, H);

        if (format == REFOCUS_FRAME_MJPEG)
            continue;
        frame = frame_of(format);
        convert(converter, &frame, &rgb, &copy, samples, true);
        for (int p = 0; p < planes_of(format); p++) {
            struct refocus_frame bad = frame;

            bad.plane[p] = NULL;
            convert(converter, &bad, &rgb, &copy, samples, false);
            bad.plane[p] = memory;
            for (int i = 0; i < NO_STRIDES; i++) {
                if (format == REFOCUS_FRAME_YUV420 && p > 0 && is_half(no_strides[i]))
                    continue;
                bad.stride[p] = no_strides[i];
                convert(converter, &bad, &rgb, &copy, samples, false);
            }
        }
        assert_status(refocus_convert_rgb8(converter, &frame, NULL, NULL), REFOCUS_ERR_ARGUMENT);
        if (own)
            assert_status(refocus_convert_copy(converter, &frame, NULL, NULL),
                          REFOCUS_ERR_ARGUMENT);
        if (format >= REFOCUS_FRAME_GREY)
            assert_status(refocus_convert_samples(converter, &frame, NULL, NULL),
                          REFOCUS_ERR_ARGUMENT);
        for (int i = 0; i < NO_STRIDES; i++) {
            struct refocus_image bad = rgb;

            bad.stride[0] = no_strides[i];
            assert_status(refocus_convert_rgb8(converter, &frame, &bad, NULL),
                          REFOCUS_ERR_ARGUMENT);
            bad = copy;
            bad.stride[refocus_format_planes(copy.format) - 1] = no_strides[i];
            if (own && !(own == REFOCUS_FORMAT_I420 && is_half(no_strides[i])))
                assert_status(refocus_convert_copy(converter, &frame, &bad, NULL),
                              REFOCUS_ERR_ARGUMENT);
        }
    }
    refocus_converter_destroy(&converter);
}

/* Structs as an older program has them, of the first layout, and as a newer one does. */
static const uint32_t no_sizes[] = {0, 4, REFOCUS_MAX_STRUCT_SIZE + 1, UINT32_MAX};
enum { NO_SIZES = sizeof no_sizes / sizeof *no_sizes };

TEST(modes_of_any_size)
{
    struct newer {
        struct refocus_source_mode known;
        uint64_t added, behind;
    } older, newer, untouched;
    struct refocus_source *source = NULL;

    memset(&older, 0xa5, sizeof older);
    newer = older;
    older.known.struct_size = REFOCUS_SIZE_TO(struct refocus_source_mode, fps);
    newer.known.struct_size = offsetof(struct newer, behind);
    assert_status(refocus_source_open(&source, "replay::size 16x12;fps 25;frames 2", NULL),
                  REFOCUS_OK);
    for (int start = 0; start < 3; start++)
        for (int i = 0; i < 2; i++) {
            struct newer got = i ? newer : older;

            if (start == 0)
                assert_status(refocus_source_get_mode(source, 0, &got.known), REFOCUS_OK);
            else if (start == 1)
                assert_status(refocus_source_start(source, NULL, &got.known, NULL), REFOCUS_OK);
            else
                assert_status(refocus_source_restart(source, &got.known, NULL), REFOCUS_OK);
            assert_true(got.known.width == 16 && got.known.height == 12 && got.known.fps > 24);
            assert_int_equal(got.known.struct_size, (i ? newer : older).known.struct_size);
            assert_true(got.added == (i ? 0 : older.added) && got.behind == older.behind);
            if (start == 1)
                refocus_source_stop(source);
        }
    for (int i = 0; i < NO_SIZES; i++) {
        newer.known.struct_size = no_sizes[i];
        untouched = newer;
        assert_status(refocus_source_get_mode(source, 0, &newer.known), REFOCUS_ERR_ARGUMENT);
        assert_status(refocus_source_restart(source, &newer.known, NULL), REFOCUS_ERR_ARGUMENT);
        assert_status(refocus_source_start(source, NULL, &newer.known, NULL), REFOCUS_ERR_ARGUMENT);
        assert_memory_equal(&newer, &untouched, sizeof newer);
    }
    refocus_source_close(&source);
}

TEST(counters_of_any_size)
{
    struct newer {
        struct refocus_source_counters known;
        uint64_t added, behind;
    } older, newer, untouched;
    struct refocus_source *source = started("replay::size 16x12;frames 2", REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame;

    memset(&older, 0xa5, sizeof older);
    newer = older;
    older.known.struct_size = REFOCUS_SIZE_TO(struct refocus_source_counters, restarts);
    newer.known.struct_size = offsetof(struct newer, behind);
    assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_OK);
    for (int i = 0; i < 2; i++) {
        struct newer got = i ? newer : older;

        refocus_source_get_counters(source, &got.known);
        assert_true(got.known.frames == 1 && got.known.released == 0 && got.known.reserved == 0);
        assert_int_equal(got.known.struct_size, (i ? newer : older).known.struct_size);
        assert_true(got.added == (i ? 0 : older.added) && got.behind == older.behind);
    }
    for (int i = 0; i < NO_SIZES; i++) {
        newer.known.struct_size = no_sizes[i];
        untouched = newer;
        refocus_source_get_counters(source, &newer.known);
        assert_memory_equal(&newer, &untouched, sizeof newer);
    }
    refocus_source_close(&source);
}

/* Convert a frame in every way that its format has. */
static void convert_grey(struct refocus_converter *converter, const struct refocus_frame *frame,
                         const struct refocus_frame *yuv, int expected)
{
    static uint8_t to[W * H * 4];
    static uint16_t samples[W * H];
    struct refocus_image rgb = refocus_image_planar(REFOCUS_FORMAT_RGB8, to, W, H);
    struct refocus_image copy = refocus_image_planar(REFOCUS_FORMAT_NV12, to, W, H);

    assert_status(refocus_convert_rgb8(converter, frame, &rgb, NULL), expected);
    assert_status(refocus_convert_samples(converter, frame, samples, NULL), expected);
    assert_status(refocus_convert_copy(converter, yuv, &copy, NULL), expected);
}

TEST(frames_of_any_size)
{
    enum { FIRST = REFOCUS_SIZE_TO(struct refocus_frame, dmabuf) };
    struct newer {
        struct refocus_frame known;
        uint64_t added;
    } grey, yuv;
    struct refocus_converter *converter = NULL;
    /* Each is alone in its memory, so that sanitizers see a read behind it. */
    struct refocus_frame *const old_grey = malloc(FIRST), *const old_yuv = malloc(FIRST);
    struct refocus_frame copy;

    assert_true(old_grey && old_yuv);
    memset(&grey, 0, sizeof grey);
    grey.known = frame_of(REFOCUS_FRAME_GREY);
    yuv = grey;
    yuv.known = frame_of(REFOCUS_FRAME_NV12);
    grey.known.struct_size = yuv.known.struct_size = FIRST;
    memcpy(old_grey, &grey, FIRST);
    memcpy(old_yuv, &yuv, FIRST);
    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    convert_grey(converter, old_grey, old_yuv, REFOCUS_OK);
    copy = refocus_frame_copy(old_yuv);
    assert_int_equal(copy.struct_size, sizeof copy);
    assert_true(copy.format == REFOCUS_FRAME_NV12 && copy.plane[1] == memory);
    free(old_grey);
    free(old_yuv);

    grey.known.struct_size = yuv.known.struct_size = sizeof grey;
    convert_grey(converter, &grey.known, &yuv.known, REFOCUS_OK);
    grey.added = yuv.added = 1;
    convert_grey(converter, &grey.known, &yuv.known, REFOCUS_ERR_UNSUPPORTED);
    copy = refocus_frame_copy(&yuv.known); /* a field unknown here is left out */
    assert_int_equal(copy.struct_size, sizeof copy);
    assert_true(copy.format == REFOCUS_FRAME_NV12 && copy.plane[1] == memory);
    for (int i = 0; i < NO_SIZES; i++) {
        grey.known.struct_size = yuv.known.struct_size = no_sizes[i];
        convert_grey(converter, &grey.known, &yuv.known, REFOCUS_ERR_ARGUMENT);
        copy = refocus_frame_copy(&yuv.known);
        assert_true(copy.struct_size == sizeof copy && copy.format == REFOCUS_FRAME_ANY &&
                    isnan(copy.lens_dioptres) && copy.dmabuf[2] == -1);
    }
    assert_int_equal(refocus_frame_copy(NULL).format, REFOCUS_FRAME_ANY);
    refocus_converter_destroy(&converter);
}

/* A source says how much of its frames there is. */
TEST(frames_of_sources)
{
    struct refocus_source *source = started("replay::size 16x12;frames 2", REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame;

    assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_OK);
    assert_int_equal(frame->struct_size, sizeof *frame);
    refocus_source_close(&source);
}

TEST(registering_nothing)
{
    static uint16_t samples[W * H], out[W * H];
    const struct refocus_pinhole pinhole = {W, H, 16, 16, 8, 6};
    const struct refocus_calibration same = {
        pinhole, pinhole, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

    assert_status(refocus_register_depth(NULL, samples, 1, out), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_register_depth(&same, NULL, 1, out), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_register_depth(&same, samples, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_register_depth(&same, samples, (double)NAN, out), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_register_depth(&same, samples, 1, out), REFOCUS_OK);
}
