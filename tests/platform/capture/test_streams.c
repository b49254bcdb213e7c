/* test_streams.c: sinks and the sources that read what they wrote; names that are refused. */
#include "check.h"

#include <locale.h>
#include <unistd.h>
#include <refocus/platform/convert.h>
#include <stdbool.h>
#include <refocus/platform/sink.h>

enum { WIDTH = 37, HEIGHT = 22, FRAMES = 4 };
static uint8_t pixels[WIDTH * HEIGHT * 3];

static struct refocus_image picture(int n)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++)
            pixels[3 * i + c] = (uint8_t)(40 + i % WIDTH / 2 * 4 + i / WIDTH / 2 * 3 + n * 7 + c);
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, WIDTH, HEIGHT, WIDTH * 3);
}

static void write_frames(const char *name)
{
    struct refocus_sink *sink = NULL;
    struct refocus_reason reason;

    assert_status(refocus_sink_open(&sink, name, &reason), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, WIDTH, HEIGHT, 25, &reason), REFOCUS_OK);
    for (int n = 0; n < FRAMES; n++) {
        const struct refocus_image image = picture(n);

        assert_status(refocus_sink_write(sink, &image, &reason), REFOCUS_OK);
    }
    assert_status(refocus_sink_close(&sink, &reason), REFOCUS_OK);
    assert_null(sink);
}

/* Every frame twice over, as with REFOCUS_SOURCE_LOOP, each byte within a bound. */
static void read_frames(const char *name, int bound)
{
    struct refocus_source *source = started(name, REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP);
    struct refocus_converter *converter = NULL;
    uint8_t back[WIDTH * HEIGHT * 3];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, back, WIDTH, HEIGHT, WIDTH * 3);

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (int n = 0; n < 2 * FRAMES; n++) {
        const struct refocus_frame *frame;
        struct refocus_reason reason;

        if (refocus_source_wait(source, 0, &frame, &reason) != REFOCUS_OK)
            fail_msg("%s: frame %d: %s", name, n, reason.text);
        assert_status(refocus_convert_rgb8(converter, frame, &image, NULL), REFOCUS_OK);
        refocus_source_release(source, frame);
        picture(n % FRAMES);
        for (size_t i = 0; i < sizeof back; i++)
            if (abs(back[i] - pixels[i]) > bound)
                fail_msg("%s: frame %d, byte %zu is %d, was %d", name, n, i, back[i], pixels[i]);
    }
    refocus_converter_destroy(&converter);
    refocus_source_close(&source);
    source = started(name, REFOCUS_SOURCE_FAST);
    for (int n = 0; n < FRAMES; n++) {
        const struct refocus_frame *frame;

        assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_OK);
        refocus_source_release(source, frame);
    }
    const struct refocus_frame *frame;
    assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_ERR_END);
    refocus_source_close(&source);
}

TEST(streams_come_back)
{
    write_frames("y4m:frames.y4m");
    read_frames("y4m:frames.y4m", 5);
    write_frames("raw:frames.rgb");
    read_frames("raw:frames.rgb,RGB24,37x22,25", 0);
}

TEST(pictures_come_back)
{
    write_frames("frame-%03d.ppm");
    read_frames("file:frame-%03d.ppm", 0);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

TEST(damage_is_named)
{
    const struct refocus_frame *frame;
    struct refocus_source *source = NULL;
    struct refocus_reason reason;

    write_text("bad.y4m", "YUV5MPEG2 W4 H4\n");
    assert_status(refocus_source_open(&source, "y4m:bad.y4m", &reason), REFOCUS_ERR_FORMAT);
    assert_null(source);
    write_text("bad.y4m", "YUV4MPEG2 W400000 H4\n");
    assert_status(refocus_source_open(&source, "y4m:bad.y4m", &reason), REFOCUS_ERR_SIZE);
    write_text("bad.y4m", "YUV4MPEG2 W4 H4 C444\n");
    assert_status(refocus_source_open(&source, "y4m:bad.y4m", &reason), REFOCUS_ERR_UNSUPPORTED);
    write_text("bad.y4m", "YUV4MPEG2 W4 H4 It\n");
    assert_status(refocus_source_open(&source, "y4m:bad.y4m", &reason), REFOCUS_ERR_UNSUPPORTED);
    assert_non_null(strstr(reason.text, "it is interlaced (It); deinterlace it first"));
    write_text("bad.y4m", "YUV4MPEG2 W4 H4\nFRAME\nabcdefghijklmnopqrstuvwxFRAME\nabc");
    source = started("y4m:bad.y4m", REFOCUS_SOURCE_FAST);
    assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_OK);
    refocus_source_release(source, frame);
    assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_ERR_FORMAT);
    assert_non_null(strstr(reason.text, "frame 1"));
    refocus_source_close(&source);
}

TEST(wrong_names_are_refused)
{
    static const struct {
        const char *name;
        int status;
    } names[] = {
        {"", REFOCUS_ERR_ARGUMENT},
        {"nothing", REFOCUS_ERR_ARGUMENT},
        {"webcam:0", REFOCUS_ERR_ARGUMENT},
        {"file:", REFOCUS_ERR_ARGUMENT},
        {"file:a-%s.png", REFOCUS_ERR_ARGUMENT},
        {"file:a-%d-%d.png", REFOCUS_ERR_ARGUMENT},
        {"file:not-there-%d.png", REFOCUS_ERR_GONE},
        {"y4m:not-there.y4m", REFOCUS_ERR_GONE},
        {"raw:x,NV12", REFOCUS_ERR_ARGUMENT},
        {"raw:x,NV99,4x4", REFOCUS_ERR_ARGUMENT},
        {"raw:not-there,NV12,4x4", REFOCUS_ERR_GONE},
        {"replay:not-there", REFOCUS_ERR_GONE},
        {"replay::size 0x4", REFOCUS_ERR_FORMAT},
        {"replay::at 3 explode", REFOCUS_ERR_FORMAT},
        {"replay::size 64x48;stride 3", REFOCUS_ERR_SIZE},
        {"replay::from y4m:not-there.y4m", REFOCUS_ERR_GONE},
        {"replay::from replay:itself", REFOCUS_ERR_FORMAT},
    };

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct refocus_reason reason = {""};
        struct refocus_source *source = NULL;
        const int status = refocus_source_open(&source, names[i].name, &reason);

        if (status != names[i].status || source || !reason.text[0])
            fail_msg("'%s' gives %d '%s'", names[i].name, status, reason.text);
    }
    assert_status(refocus_source_open(NULL, "x", NULL), REFOCUS_ERR_ARGUMENT);
}

/* Sample i of pixel (x, y) of a picture of Y, U and V. */
static uint8_t *sample_of(const struct refocus_image *p, int i, int x, int y)
{
    if (p->format == REFOCUS_FORMAT_YUYV)
        return p->plane[0] + y * p->stride[0] + (i ? x / 2 * 4 + 2 * i - 1 : 2 * x);
    if (i == 0)
        return p->plane[0] + y * p->stride[0] + x;
    if (p->format == REFOCUS_FORMAT_I420)
        return p->plane[i] + y / 2 * p->stride[i] + x / 2;
    return p->plane[1] + y / 2 * p->stride[1] + x / 2 * 2 +
           ((i == 2) ^ (p->format == REFOCUS_FORMAT_NV21));
}

/* A picture in memory, and what a y4m stream of it is, byte for byte. */
static void check_y4m_of(uint32_t format, int planes, uint32_t range)
{
    enum { W = 7, H = 5, HALF = 4 };
    static uint8_t memory[3][16 * H], bytes[1000], expected[1000];
    struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                  .format = format,
                                  .width = W,
                                  .height = H,
                                  .range = range};
    const bool tall = format == REFOCUS_FORMAT_YUYV;
    struct refocus_sink *sink = NULL;
    size_t n, length;
    FILE *file;

    for (int i = 0; i < planes; i++) {
        image.plane[i] = memory[i];
        image.stride[i] = 16;
        for (size_t k = 0; k < sizeof memory[i]; k++)
            memory[i][k] = (uint8_t)(37 * k + 91 * (size_t)i);
    }
    length = (size_t)sprintf((char *)expected,
                             "YUV4MPEG2 W7 H5 F25:1 Ip A1:1 C%s XCOLORRANGE=%s\nFRAME\n",
                             tall ? "422" : "420jpeg", range ? "FULL" : "LIMITED");
    for (int i = 0; i < 3; i++)
        for (int y = 0; y < (i && !tall ? (H + 1) / 2 : H); y++)
            for (int x = 0; x < (i ? HALF : W); x++)
                expected[length++] = *sample_of(&image, i, i ? 2 * x : x, i && !tall ? 2 * y : y);
    assert_status(refocus_sink_open(&sink, "y4m:yuv.y4m", NULL), REFOCUS_OK);
    assert_int_equal(refocus_sink_takes(sink, format), 1);
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
    image.range = !range; /* a stream of one range has begun */
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    file = fopen("yuv.y4m", "rb");
    assert_non_null(file);
    n = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_int_equal(n, length);
    assert_memory_equal(bytes, expected, length);
}

TEST(y4m_keeps_codes)
{
    static const uint32_t formats[] = {REFOCUS_FORMAT_NV12, REFOCUS_FORMAT_NV21,
                                       REFOCUS_FORMAT_I420, REFOCUS_FORMAT_YUYV};
    static const int planes[] = {2, 2, 3, 1};
    struct refocus_sink *sink = NULL;
    struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                  .format = REFOCUS_FORMAT_NV12,
                                  .width = 4,
                                  .height = 4};

    for (int i = 0; i < 4; i++)
        for (uint32_t range = 0; range < 2; range++)
            check_y4m_of(formats[i], planes[i], range);
    assert_status(refocus_sink_open(&sink, "raw:yuv.raw", NULL), REFOCUS_OK); /* RGB24 */
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_NV12), 0);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_RGB8), 1);
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
}

enum { RAW_W = 7, RAW_H = 5 };

/* A picture of any format, rows with gaps. */
static struct refocus_image noisy(uint32_t format, uint8_t memory[3][32 * RAW_H], uint32_t range)
{
    struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                  .format = format,
                                  .width = RAW_W,
                                  .height = RAW_H,
                                  .range = range};

    for (int i = 0; i < 3; i++) {
        image.plane[i] = memory[i];
        image.stride[i] = 32;
        for (int k = 0; k < 32 * RAW_H; k++)
            memory[i][k] = (uint8_t)(37 * k + 91 * i);
    }
    return image;
}

/* Pictures of one format in frames of another with as many samples, back by the source. */
static void check_raw_of(uint32_t format, const char *name, uint32_t frame_format, bool own)
{
    static const uint32_t image_formats[] = {[REFOCUS_FRAME_NV12] = REFOCUS_FORMAT_NV12,
                                             [REFOCUS_FRAME_NV21] = REFOCUS_FORMAT_NV21,
                                             [REFOCUS_FRAME_YUV420] = REFOCUS_FORMAT_I420,
                                             [REFOCUS_FRAME_YUYV] = REFOCUS_FORMAT_YUYV};
    static uint8_t memory[3][32 * RAW_H];
    struct refocus_image image = noisy(format, memory, 1), back = {0};
    const int tall = format == REFOCUS_FORMAT_YUYV;
    struct refocus_source *source;
    const struct refocus_frame *frame;
    struct refocus_sink *sink = NULL;
    uint8_t swapped[2 * (RAW_W + 1) * RAW_H];
    char path[80];

    snprintf(path, sizeof path, "raw:some,%s.raw,%s", name, own ? "OWN" : name);
    assert_status(refocus_sink_open(&sink, path, NULL), REFOCUS_OK);
    assert_int_equal(refocus_sink_takes(sink, format), 1);
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_OK);
    for (int n = 0; n < 2; n++)
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
    image.range = 0; /* nothing in the file says so */
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);

    snprintf(path, sizeof path, "raw:some,%s.raw,%s,7x5", name, name);
    source = started(path, REFOCUS_SOURCE_FAST);
    for (int n = 0; n < 2; n++) {
        assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_OK);
        assert_int_equal(frame->format, frame_format);
        back = (struct refocus_image){.struct_size = sizeof(struct refocus_image),
                                      .format = REFOCUS_FORMAT_YUYV,
                                      .width = RAW_W,
                                      .height = RAW_H};
        if (frame_format == REFOCUS_FRAME_UYVY) {
            for (size_t i = 0; i < 2 * (RAW_W + 1) * RAW_H; i++)
                swapped[i] = frame->plane[0][i ^ 1];
            back.plane[0] = swapped;
            back.stride[0] = frame->stride[0];
        } else {
            back.format = image_formats[frame_format];
            for (int i = 0; i < 3; i++) {
                back.plane[i] = (uint8_t *)(uintptr_t)frame->plane[i];
                back.stride[i] = frame->stride[i];
            }
        }
        for (int y = 0; y < RAW_H; y++)
            for (int x = 0; x < RAW_W + tall; x++)
                for (int i = 0; i < 3; i++)
                    if (*sample_of(&back, i, x, y) != *sample_of(&image, i, x, y))
                        fail_msg("%s: sample %d of (%d, %d) is %d, was %d", path, i, x, y,
                                 *sample_of(&back, i, x, y), *sample_of(&image, i, x, y));
        refocus_source_release(source, frame);
    }
    assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_ERR_END);
    refocus_source_close(&source);
}

TEST(raw_keeps_codes)
{
    static const struct {
        uint32_t format;
        const char *name;
        uint32_t frame;
    } kinds[] = {{REFOCUS_FORMAT_NV12, "NV12", REFOCUS_FRAME_NV12},
                 {REFOCUS_FORMAT_NV21, "nv21", REFOCUS_FRAME_NV21},
                 {REFOCUS_FORMAT_I420, "YUV420", REFOCUS_FRAME_YUV420},
                 {REFOCUS_FORMAT_YUYV, "YUYV", REFOCUS_FRAME_YUYV}};

    for (int i = 0; i < 4; i++) {
        check_raw_of(kinds[i].format, kinds[i].name, kinds[i].frame, true);
        for (int k = 0; k < 3 && i < 3; k++)
            check_raw_of(kinds[i].format, kinds[k].name, kinds[k].frame, false);
    }
    check_raw_of(REFOCUS_FORMAT_YUYV, "YUYV", REFOCUS_FRAME_YUYV, false);
    check_raw_of(REFOCUS_FORMAT_YUYV, "UYVY", REFOCUS_FRAME_UYVY, false);
}

/* RGB8 into every format, and what is no format. */
TEST(raw_formats)
{
    static const struct {
        const char *name;
        int bound;
    } formats[] = {{"own", 0},  {"RGB24", 0}, {"BGR24", 0},  {"RGBX", 0}, {"BGRX", 0},
                   {"NV12", 5}, {"NV21", 5},  {"YUV420", 5}, {"YUYV", 5}, {"UYVY", 5}};
    static const char *const wrong[] = {"raw:x,NV99", "raw:x,",    "raw:x,GREY", "raw:x,MJPEG",
                                        "raw:,NV12",  "raw:x,Z16", "raw:x,any"};
    struct refocus_sink *sink = NULL;
    struct refocus_image yuv = {.struct_size = sizeof(struct refocus_image),
                                .format = REFOCUS_FORMAT_YUYV,
                                .width = 4,
                                .height = 4};

    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        char name[80];

        snprintf(name, sizeof name, "raw:all.raw,%s", formats[i].name);
        write_frames(name);
        snprintf(name, sizeof name, "raw:all.raw,%s,37x22,25", i ? formats[i].name : "RGB24");
        read_frames(name, formats[i].bound);
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct refocus_reason reason = {""};

        if (refocus_sink_open(&sink, wrong[i], &reason) != REFOCUS_ERR_ARGUMENT || sink ||
            !reason.text[0])
            fail_msg("'%s' is not refused", wrong[i]);
    }
    assert_int_equal(access("x", F_OK), -1); /* nothing was begun */
    assert_status(refocus_sink_open(&sink, "raw:half.yuv,NV12", NULL), REFOCUS_OK);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_I420), 1);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_YUYV), 1);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    assert_status(refocus_sink_open(&sink, "raw:rgbx.raw,RGBX", NULL), REFOCUS_OK);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_YUYV), 0);
    assert_status(refocus_sink_start_image(sink, &yuv, 25, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
}

/* A code of U or V of a picture in a format with other rows of them, by the words of sink.h. */
static int chroma_as(const struct refocus_image *image, bool tall, int i, int x, int y)
{
    if (tall || image->format != REFOCUS_FORMAT_YUYV)
        return *sample_of(image, i, x, y);
    y = y / 2 * 2;
    return (*sample_of(image, i, x, y) +
            *sample_of(image, i, x, y + 1 < image->height ? y + 1 : y) + 1) /
           2;
}

/* 4:2:0 into 4:2:2 and back: codes of Y stay, rows of U and V come twice or are mixed. */
TEST(raw_of_other_samples)
{
    static const struct {
        uint32_t from, to;
        const char *name;
    } kinds[] = {{REFOCUS_FORMAT_NV12, REFOCUS_FORMAT_YUYV, "YUYV"},
                 {REFOCUS_FORMAT_NV21, REFOCUS_FORMAT_YUYV, "YUYV"},
                 {REFOCUS_FORMAT_I420, REFOCUS_FORMAT_YUYV, "UYVY"},
                 {REFOCUS_FORMAT_YUYV, REFOCUS_FORMAT_NV12, "NV12"},
                 {REFOCUS_FORMAT_YUYV, REFOCUS_FORMAT_NV21, "NV21"},
                 {REFOCUS_FORMAT_YUYV, REFOCUS_FORMAT_I420, "YUV420"}};
    static uint8_t memory[3][32 * RAW_H];
    struct refocus_converter *converter;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const struct refocus_image image = noisy(kinds[k].from, memory, 1);
        const bool tall = kinds[k].to == REFOCUS_FORMAT_YUYV;
        uint8_t bytes[2 * (RAW_W + 1) * RAW_H];
        struct refocus_image back = refocus_image_planar(kinds[k].to, bytes, RAW_W, RAW_H);
        const struct refocus_frame *frame;
        struct refocus_source *source;
        struct refocus_sink *sink = NULL;
        char path[80];

        snprintf(path, sizeof path, "raw:other.raw,%s", kinds[k].name);
        assert_status(refocus_sink_open(&sink, path, NULL), REFOCUS_OK);
        assert_int_equal(refocus_sink_takes(sink, kinds[k].from), 1);
        assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_OK);
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
        snprintf(path, sizeof path, "raw:other.raw,%s,7x5", kinds[k].name);
        source = started(path, REFOCUS_SOURCE_FAST);
        assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_OK);
        assert_status(refocus_convert_copy(converter, frame, &back, NULL), REFOCUS_OK);
        for (int y = 0; y < RAW_H; y++)
            for (int x = 0; x < RAW_W; x++)
                for (int i = 0; i < 3; i++)
                    assert_int_equal(*sample_of(&back, i, x, y),
                                     i ? chroma_as(&image, tall, i, x, y)
                                       : *sample_of(&image, 0, x, y));
        refocus_source_release(source, frame);
        refocus_source_close(&source);
    }
    refocus_converter_destroy(&converter);
}

/* 4:2:2 comes back from y4m as the YUYV that it was. */
TEST(y4m_422_comes_back)
{
    static uint8_t memory[3][32 * RAW_H];
    struct refocus_image image = noisy(REFOCUS_FORMAT_YUYV, memory, 1);
    struct refocus_source *source;
    const struct refocus_frame *frame;
    struct refocus_sink *sink = NULL;

    assert_status(refocus_sink_open(&sink, "y4m:tall.y4m", NULL), REFOCUS_OK);
    assert_status(refocus_sink_start_image(sink, &image, 25, NULL), REFOCUS_OK);
    for (int n = 0; n < 2; n++)
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    source = started("y4m:tall.y4m", REFOCUS_SOURCE_FAST);
    for (int n = 0; n < 2; n++) {
        struct refocus_image back = {.struct_size = sizeof(struct refocus_image),
                                     .format = REFOCUS_FORMAT_YUYV};

        assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_OK);
        assert_int_equal(frame->format, REFOCUS_FRAME_YUYV);
        assert_true(frame->flags & REFOCUS_FRAME_FULL_RANGE);
        back.plane[0] = (uint8_t *)(uintptr_t)frame->plane[0];
        back.stride[0] = frame->stride[0];
        for (int y = 0; y < RAW_H; y++) {
            for (int x = 0; x < RAW_W; x++)
                for (int i = 0; i < 3; i++)
                    assert_int_equal(*sample_of(&back, i, x, y), *sample_of(&image, i, x, y));
            /* the pixel that completes a pair repeats the last */
            assert_int_equal(*sample_of(&back, 0, RAW_W, y), *sample_of(&image, 0, RAW_W - 1, y));
        }
        refocus_source_release(source, frame);
    }
    assert_status(refocus_source_wait(source, 0, &frame, NULL), REFOCUS_ERR_END);
    refocus_source_close(&source);
}

TEST(sinks_refuse_what_is_wrong)
{
    struct refocus_sink *sink = NULL;
    struct refocus_image image = picture(0);

    assert_status(refocus_sink_open(&sink, "nowhere", NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_open(&sink, "y4m:", NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_open(&sink, "y4m:/not/there/x", NULL), REFOCUS_ERR_GONE);
    assert_null(sink);
    assert_status(refocus_sink_open(&sink, "raw:changes.rgb", NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_STATE);
    assert_status(refocus_sink_start(sink, WIDTH, HEIGHT, 25, NULL), REFOCUS_OK);
    image.width--;
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_sink_start(sink, WIDTH - 1, HEIGHT, 25, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
}

TEST(replay_replays)
{
    struct refocus_source *source;
    const struct refocus_frame *frame;
    int n = 0;

    write_frames("raw:frames.rgb");
    source = started("replay::from raw:frames.rgb,RGB24,37x22,25;frames 10;at 2 drop",
                     REFOCUS_SOURCE_FAST);
    for (; refocus_source_wait(source, 100, &frame, NULL) == REFOCUS_OK; n++) {
        picture(n % FRAMES);
        for (int y = 0; y < HEIGHT; y++)
            assert_memory_equal(frame->plane[0] + y * frame->stride[0], pixels + y * WIDTH * 3,
                                WIDTH * 3);
        refocus_source_release(source, frame);
    }
    assert_int_equal(n, 9);
    refocus_source_close(&source);
}

/* Rates have a point in a program whose locale has a comma, as far as the machine knows one. */
TEST(rates_ignore_the_locale)
{
    static const char *const names[] = {"raw:rate.tmp,RGB24,4x4,29.97",
                                        "replay::size 4x4;fps 29.97"};

    write_text("rate.tmp", "");
    setlocale(LC_NUMERIC, "de_DE.UTF-8");
    for (int i = 0; i < 2; i++) {
        struct refocus_source_mode mode = refocus_source_mode_default();
        struct refocus_source *source = NULL;

        assert_status(refocus_source_open(&source, names[i], NULL), REFOCUS_OK);
        assert_status(refocus_source_start(source, NULL, &mode, NULL), REFOCUS_OK);
        assert_true(mode.fps == 29.97);
        refocus_source_close(&source);
    }
    setlocale(LC_NUMERIC, "C");
    remove("rate.tmp");
}
