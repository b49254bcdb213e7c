/* test_convert.c: formats of cameras against the formulas of the standards in double precision. */
#include "check.h"

#include <math.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/file.h>
#include "layout.h"
#include "replay_scene.h"
#include "rgb_to_yuv.h"
#ifdef RF_HAVE_JPEG
#include <turbojpeg.h>
#endif

static uint32_t seed = 1;

static uint8_t noise(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint8_t)(seed >> 24);
}

enum { PAD = 13, MOST = 64 };

/* A frame of noise with rows longer than they need to be. */
static void make_frame(struct refocus_frame *frame, uint32_t format, int width, int height,
                       uint8_t memory[3][MOST * MOST * 4 + PAD * MOST])
{
    *frame = refocus_frame_default();
    frame->format = format;
    frame->width = width;
    frame->height = height;
    for (int i = 0; i < rf_format_planes(format); i++) {
        frame->stride[i] = (ptrdiff_t)rf_plane_row(format, i, width) + PAD + i;
        frame->plane[i] = memory[i];
    }
    for (int i = 0; i < 3; i++)
        for (size_t n = 0; n < sizeof memory[i]; n++)
            memory[i][n] = noise();
}

/* Y, U, V of a pixel, from the meaning of the formats and not from the converter. */
static void sample(const struct refocus_frame *f, int x, int y, double yuv[3])
{
    const uint8_t *p0 = f->plane[0] + y * f->stride[0];
    const uint8_t *p1 = f->plane[1] ? f->plane[1] + y / 2 * f->stride[1] : NULL;
    const uint8_t *p2 = f->plane[2] ? f->plane[2] + y / 2 * f->stride[2] : NULL;

    switch (f->format) {
    case REFOCUS_FRAME_YUYV:
        yuv[0] = p0[2 * x], yuv[1] = p0[x / 2 * 4 + 1], yuv[2] = p0[x / 2 * 4 + 3];
        break;
    case REFOCUS_FRAME_UYVY:
        yuv[0] = p0[2 * x + 1], yuv[1] = p0[x / 2 * 4], yuv[2] = p0[x / 2 * 4 + 2];
        break;
    case REFOCUS_FRAME_NV12:
        yuv[0] = p0[x], yuv[1] = p1[x / 2 * 2], yuv[2] = p1[x / 2 * 2 + 1];
        break;
    case REFOCUS_FRAME_NV21:
        yuv[0] = p0[x], yuv[1] = p1[x / 2 * 2 + 1], yuv[2] = p1[x / 2 * 2];
        break;
    default:
        yuv[0] = p0[x], yuv[1] = p1[x / 2], yuv[2] = p2[x / 2];
        break;
    }
}

static double clamp(double v)
{
    return v < 0 ? 0 : v > 255 ? 255 : v;
}

static void expect(const double yuv[3], uint32_t matrix, int full, double rgb[3])
{
    const double kr = matrix ? 0.2126 : 0.299, kb = matrix ? 0.0722 : 0.114, kg = 1 - kr - kb;
    const double y = full ? yuv[0] / 255 : (yuv[0] - 16) / 219;
    const double u = (yuv[1] - 128) / (full ? 255 : 224), v = (yuv[2] - 128) / (full ? 255 : 224);

    rgb[0] = clamp(255 * (y + 2 * (1 - kr) * v));
    rgb[1] = clamp(255 * (y - 2 * (1 - kb) * kb / kg * u - 2 * (1 - kr) * kr / kg * v));
    rgb[2] = clamp(255 * (y + 2 * (1 - kb) * u));
}

static uint8_t memory[3][MOST * MOST * 4 + PAD * MOST];
static uint8_t out[MOST * MOST * 3 + PAD * MOST];

static void check_frame(struct refocus_converter *converter, uint32_t format, int width, int height,
                        uint32_t matrix, int full)
{
    struct refocus_frame frame;
    struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, width, height, width * 3 + PAD);
    double worst = 0;

    make_frame(&frame, format, width, height, memory);
    frame.matrix = matrix;
    frame.flags = full ? REFOCUS_FRAME_FULL_RANGE : 0;
    memset(out, 0xa5, sizeof out);
    assert_status(refocus_convert_rgb8(converter, &frame, &image, NULL), REFOCUS_OK);
    for (int y = 0; y < height; y++) {
        const uint8_t *row = out + y * image.stride[0];

        for (int x = 0; x < width; x++) {
            double yuv[3], rgb[3];

            sample(&frame, x, y, yuv);
            expect(yuv, matrix, full, rgb);
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs(rgb[c] - row[3 * x + c]));
        }
        for (int x = width * 3; x < width * 3 + PAD; x++)
            assert_int_equal(row[x], 0xa5);
    }
    if (worst > 1)
        fail_msg("%s %dx%d: off by %g", refocus_frame_format_name(format), width, height, worst);
}

/* A frame in Y, U and V copied: every sample, the matrix and the range, nothing else. */
static void check_copy(struct refocus_converter *converter, uint32_t format, int width, int height)
{
    static uint8_t copy[MOST * MOST * 4 + PAD * MOST * 3];
    const uint32_t kept = refocus_frame_image_format(format);
    struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                  .format = kept,
                                  .width = width,
                                  .height = height};
    struct refocus_frame frame, seen;
    size_t at = 0;

    make_frame(&frame, format, width, height, memory);
    frame.matrix = (uint32_t)width % 2;
    frame.flags = height % 2 ? REFOCUS_FRAME_FULL_RANGE : 0;
    memset(copy, 0xa5, sizeof copy);
    seen = frame;
    seen.format = format == REFOCUS_FRAME_UYVY ? (uint32_t)REFOCUS_FRAME_YUYV : format;
    for (int i = 0; i < rf_format_planes(format); i++) {
        image.plane[i] = copy + at;
        image.stride[i] = (ptrdiff_t)rf_plane_row(format, i, width) + PAD;
        seen.plane[i] = image.plane[i];
        seen.stride[i] = image.stride[i];
        at += (size_t)image.stride[i] * (size_t)rf_plane_rows(format, i, height);
    }
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_OK);
    assert_int_equal(image.matrix, frame.matrix);
    assert_int_equal(image.range, height % 2 ? REFOCUS_RANGE_FULL : REFOCUS_RANGE_LIMITED);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double is[3], should[3];

            sample(&frame, x, y, should);
            sample(&seen, x, y, is);
            for (int c = 0; c < 3; c++)
                assert_int_equal((int)is[c], (int)should[c]);
        }
    }
    for (int i = 0; i < rf_format_planes(format); i++)
        for (int y = 0; y < rf_plane_rows(format, i, height); y++)
            for (int x = 1; x <= PAD; x++)
                assert_int_equal(image.plane[i][(y + 1) * image.stride[i] - x], 0xa5);
    image.format = REFOCUS_FORMAT_RGB8;
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_ERR_ARGUMENT);
    image.format = kept;
    image.stride[0] = rf_plane_row(format, 0, width) - 1;
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_ERR_ARGUMENT);
    frame.format = REFOCUS_FRAME_RGB24;
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_ERR_UNSUPPORTED);
}

TEST(copies_are_exact)
{
    struct refocus_converter *converter = NULL;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (uint32_t format = REFOCUS_FRAME_YUYV; format <= REFOCUS_FRAME_YUV420; format++)
        for (int size = 1; size < MOST; size += 6)
            check_copy(converter, format, size, MOST - size);
    assert_int_equal(refocus_frame_image_format(REFOCUS_FRAME_MJPEG), REFOCUS_FORMAT_NONE);
    refocus_converter_destroy(&converter);
}

TEST(yuv_is_the_formula)
{
    struct refocus_converter *converter = NULL;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (uint32_t format = REFOCUS_FRAME_YUYV; format <= REFOCUS_FRAME_YUV420; format++)
        for (int size = 1; size < MOST; size += 9)
            for (int kind = 0; kind < 4; kind++)
                check_frame(converter, format, size, MOST - size, (uint32_t)kind & 1, kind / 2);
    refocus_converter_destroy(&converter);
    assert_null(converter);
}

TEST(rgb_is_exact)
{
    static const int order[][4] = {{0, 1, 2, 3}, {2, 1, 0, 3}, {0, 1, 2, 4}, {2, 1, 0, 4}};
    struct refocus_converter *converter = NULL;
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 31, 17, 31 * 3);
    struct refocus_frame frame;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (uint32_t format = REFOCUS_FRAME_RGB24; format <= REFOCUS_FRAME_BGRX; format++) {
        const int *o = order[format - REFOCUS_FRAME_RGB24];

        make_frame(&frame, format, 31, 17, memory);
        assert_status(refocus_convert_rgb8(converter, &frame, &image, NULL), REFOCUS_OK);
        for (int y = 0; y < 17; y++)
            for (int x = 0; x < 31; x++)
                for (int c = 0; c < 3; c++)
                    assert_int_equal(out[(y * 31 + x) * 3 + c],
                                     frame.plane[0][y * frame.stride[0] + x * o[3] + o[c]]);
    }
    refocus_converter_destroy(&converter);
}

TEST(samples_are_exact)
{
    struct refocus_converter *converter = NULL;
    struct refocus_frame frame;
    uint16_t samples[23 * 11];

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (uint32_t format = REFOCUS_FRAME_GREY; format <= REFOCUS_FRAME_Z16; format++) {
        make_frame(&frame, format, 23, 11, memory);
        assert_status(refocus_convert_samples(converter, &frame, samples, NULL), REFOCUS_OK);
        for (int y = 0; y < 11; y++)
            for (int x = 0; x < 23; x++) {
                const uint8_t *row = frame.plane[0] + y * frame.stride[0];
                const int expected =
                    format == REFOCUS_FRAME_GREY ? row[x] * 257 : row[2 * x] + 256 * row[2 * x + 1];

                assert_int_equal(samples[y * 23 + x], expected);
            }
    }
    make_frame(&frame, REFOCUS_FRAME_NV12, 23, 11, memory);
    assert_status(refocus_convert_samples(converter, &frame, samples, NULL),
                  REFOCUS_ERR_UNSUPPORTED);
    refocus_converter_destroy(&converter);
}

TEST(bad_frames_are_refused)
{
    struct refocus_converter *converter = NULL;
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 32, 16, 32 * 3);
    struct refocus_reason reason;
    struct refocus_frame frame;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    make_frame(&frame, REFOCUS_FRAME_NV12, 32, 16, memory);
    frame.stride[1] = 31;
    assert_status(refocus_convert_rgb8(converter, &frame, &image, &reason), REFOCUS_ERR_ARGUMENT);
    assert_non_null(strstr(reason.text, "plane 1"));
    frame.stride[1] = 32;
    frame.plane[1] = NULL;
    assert_status(refocus_convert_rgb8(converter, &frame, &image, &reason), REFOCUS_ERR_ARGUMENT);
    make_frame(&frame, REFOCUS_FRAME_YUYV, 32, 18, memory);
    assert_status(refocus_convert_rgb8(converter, &frame, &image, &reason), REFOCUS_ERR_ARGUMENT);
    frame.format = REFOCUS_FRAME_FORMAT_COUNT;
    frame.height = 16;
    assert_status(refocus_convert_rgb8(converter, &frame, &image, &reason), REFOCUS_ERR_ARGUMENT);
    refocus_converter_destroy(&converter);
}

/* Pictures that sinks write come back: each pixel within the loss of chroma at half the size, which
 * is none for a picture of one colour in each 2x2 block. */
TEST(encoding_comes_back)
{
    struct refocus_converter *converter = NULL;
    uint8_t rgb[16 * 16 * 3], back[16 * 16 * 3];
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, 16, 16, 48);
    struct refocus_image image2 = refocus_image_packed(REFOCUS_FORMAT_RGB8, back, 16, 16, 48);
    struct refocus_frame frame;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (uint32_t i = 0; i < 2 * (uint32_t)REFOCUS_FRAME_BGRX; i++) {
        const uint32_t format = REFOCUS_FRAME_YUYV + i / 2;

        make_frame(&frame, format, 16, 16, memory);
        frame.matrix = i % 2 ? REFOCUS_MATRIX_BT709 : REFOCUS_MATRIX_BT601;
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 16; x++)
                for (int c = 0; c < 3; c++)
                    rgb[(y * 16 + x) * 3 + c] =
                        (uint8_t)((x / 2 * 37 + y / 2 * 91 + c * 71) * 5 % 256);
        assert_true(rf_can_encode(format));
        rf_encode(&image, &frame);
        assert_status(refocus_convert_rgb8(converter, &frame, &image2, NULL), REFOCUS_OK);
        for (size_t k = 0; k < sizeof rgb; k++)
            if (abs(rgb[k] - back[k]) > 3)
                fail_msg("%s, matrix %d: byte %zu is %d, was %d", refocus_frame_format_name(format),
                         (int)frame.matrix, k, back[k], rgb[k]);
    }
    refocus_converter_destroy(&converter);
}

#ifdef RF_HAVE_JPEG
TEST(jpegs_are_decoded_or_refused)
{
    static uint8_t rgb[32 * 16 * 3], back[32 * 16 * 3], bytes[8192];
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, 32, 16, 96);
    struct refocus_image image2 = refocus_image_packed(REFOCUS_FORMAT_RGB8, back, 32, 16, 96);
    struct refocus_converter *converter = NULL;
    struct refocus_frame frame = refocus_frame_default();
    FILE *file;

    for (int i = 0; i < 32 * 16 * 3; i++)
        rgb[i] = (uint8_t)(60 + i / 3 % 32 * 3 + i % 3);
    assert_status(refocus_image_write("frame.jpg", &image, NULL, NULL), REFOCUS_OK);
    file = fopen("frame.jpg", "rb");
    assert_non_null(file);
    frame.format = REFOCUS_FRAME_MJPEG;
    frame.width = 32;
    frame.height = 16;
    frame.plane[0] = bytes;
    frame.bytes = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    assert_status(refocus_convert_rgb8(converter, &frame, &image2, NULL), REFOCUS_OK);
    for (size_t i = 0; i < sizeof rgb; i++)
        assert_true(abs(rgb[i] - back[i]) <= 6);
    frame.bytes /= 2;
    assert_status(refocus_convert_rgb8(converter, &frame, &image2, NULL), REFOCUS_ERR_FORMAT);
    frame.bytes = 0;
    assert_status(refocus_convert_rgb8(converter, &frame, &image2, NULL), REFOCUS_ERR_FORMAT);
    refocus_converter_destroy(&converter);

    /* A camera of MJPEG gives such frames, too. */
    struct refocus_source *source = started("replay::jpeg frame.jpg", REFOCUS_SOURCE_FAST);
    const struct refocus_frame *got;
    assert_status(refocus_source_wait(source, 100, &got, NULL), REFOCUS_OK);
    assert_int_equal(got->format, REFOCUS_FRAME_MJPEG);
    assert_int_equal(got->width, 32);
    assert_memory_equal(got->plane[0], bytes, (size_t)got->bytes);
    refocus_source_close(&source);
}

/* A JPEG picture whose samples are slopes; Y is 4 x + y, and so on, which is met within 2. */
static void encode(struct refocus_frame *frame, int subsampling, int width, int height)
{
    static uint8_t codes[3][64 * 64];
    static unsigned char jpeg[65536];
    unsigned char *to = jpeg;
    unsigned long bytes = sizeof jpeg;
    const unsigned char *plane[3] = {codes[0], codes[1], codes[2]};
    const int strides[3] = {64, 64, 64};
    tjhandle handle = tjInitCompress();

    for (int i = 0; i < 3; i++)
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++)
                codes[i][64 * y + x] = (uint8_t)(i == 0 ? 4 * x + y : 100 + 20 * i + x + 2 * y);
    assert_non_null(handle);
    assert_int_equal(tjCompressFromYUVPlanes(handle, plane, width, strides, height, subsampling,
                                             &to, &bytes, 100, TJFLAG_NOREALLOC),
                     0);
    tjDestroy(handle);
    *frame = refocus_frame_default();
    frame->format = REFOCUS_FRAME_MJPEG;
    frame->width = width;
    frame->height = height;
    frame->plane[0] = jpeg;
    frame->bytes = bytes;
}

static void check_jpeg_yuv(struct refocus_converter *converter, int subsampling, int width,
                           int height, uint32_t format)
{
    static uint8_t codes[64 * 64 * 2 + PAD];
    const int down = subsampling == TJSAMP_420 ? 1 : 0;
    struct refocus_frame frame;
    struct refocus_image image = refocus_image_planar(format, codes, width, height);
    const size_t bytes = refocus_image_bytes(format, width, height);

    encode(&frame, subsampling, width, height);
    assert_int_equal(refocus_convert_image_format(converter, &frame), format);
    memset(codes, 0xa5, sizeof codes);
    image.matrix = REFOCUS_MATRIX_BT709;
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_OK);
    assert_int_equal(image.matrix, REFOCUS_MATRIX_BT601);
    assert_int_equal(image.range, REFOCUS_RANGE_FULL);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const uint8_t *row = codes + image.stride[0] * y;
            const int luma = down ? row[x] : row[2 * x];

            assert_true(abs(luma - (4 * x + y)) <= 2);
            for (int i = 1; i < 3; i++) {
                const int code = down ? image.plane[i][image.stride[i] * (y / 2) + x / 2]
                                      : row[x / 2 * 4 + 2 * i - 1];

                assert_true(abs(code - (100 + 20 * i + x / 2 + 2 * (y >> down))) <= 2);
            }
        }
    for (int i = 0; i < PAD; i++)
        assert_int_equal(codes[bytes + (size_t)i], 0xa5);
    frame.bytes -= 20;
    assert_status(refocus_convert_copy(converter, &frame, &image, NULL), REFOCUS_ERR_FORMAT);
}

TEST(jpegs_keep_their_samples)
{
    static const int none[][3] = {{TJSAMP_444, 32, 16}, {TJSAMP_GRAY, 32, 16},
                                  {TJSAMP_420, 31, 16}, {TJSAMP_420, 32, 15},
                                  {TJSAMP_422, 31, 16}, {TJSAMP_440, 32, 16}};
    struct refocus_converter *converter = NULL;
    struct refocus_frame frame;

    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    /* Sides that are no whole number of blocks, and planes that get larger. */
    check_jpeg_yuv(converter, TJSAMP_420, 32, 16, REFOCUS_FORMAT_I420);
    check_jpeg_yuv(converter, TJSAMP_420, 38, 22, REFOCUS_FORMAT_I420);
    check_jpeg_yuv(converter, TJSAMP_422, 32, 16, REFOCUS_FORMAT_YUYV);
    check_jpeg_yuv(converter, TJSAMP_422, 38, 21, REFOCUS_FORMAT_YUYV);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        encode(&frame, none[i][0], none[i][1], none[i][2]);
        assert_int_equal(refocus_convert_image_format(converter, &frame), REFOCUS_FORMAT_NONE);
    }
    encode(&frame, TJSAMP_420, 32, 16);
    frame.width = 16; /* The picture says another size. */
    assert_int_equal(refocus_convert_image_format(converter, &frame), REFOCUS_FORMAT_NONE);
    frame.bytes = 0;
    assert_int_equal(refocus_convert_image_format(converter, &frame), REFOCUS_FORMAT_NONE);
    frame.plane[0] = NULL;
    assert_int_equal(refocus_convert_image_format(converter, &frame), REFOCUS_FORMAT_NONE);
    refocus_converter_destroy(&converter);
}
#endif

/* Registration ---------------------------------------------------------------------------- */

static struct refocus_calibration same_cameras(void)
{
    struct refocus_calibration c = {.depth = {32, 24, 40, 40, 15.5, 11.5},
                                    .colour = {32, 24, 40, 40, 15.5, 11.5},
                                    .rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

    return c;
}

TEST(registering_onto_itself_is_nothing)
{
    const struct refocus_calibration c = same_cameras();
    uint16_t from[32 * 24], to[32 * 24];

    for (int i = 0; i < 32 * 24; i++)
        from[i] = (uint16_t)(i % 7 == 0 ? 0 : 500 + i * 3);
    assert_status(refocus_register_depth(&c, from, 0.001, to), REFOCUS_OK);
    assert_memory_equal(from, to, sizeof from);
}

TEST(registering_shifts_near_things_more)
{
    struct refocus_calibration c = same_cameras();
    uint16_t from[32 * 24], to[32 * 24];

    /* 2 m away everywhere but for a square at 1 m; the baseline of 0.1 m shifts them by
     * 40 * 0.1 / z = 2 and 4 pixels. */
    c.translation_m[0] = 0.1;
    for (int y = 0; y < 24; y++)
        for (int x = 0; x < 32; x++)
            from[y * 32 + x] = x >= 10 && x < 16 ? 1000 : 2000;
    assert_status(refocus_register_depth(&c, from, 0.001, to), REFOCUS_OK);
    for (int x = 0; x < 32; x++) {
        const int expected = x < 2               ? 0
                             : x >= 14 && x < 20 ? 1000
                             : x >= 12 && x < 14 ? 0 /* seen by the colour camera alone */
                                                 : 2000;

        if (to[12 * 32 + x] != expected)
            fail_msg("pixel %d is %d, not %d", x, to[12 * 32 + x], expected);
    }
    c.depth.fx = 0;
    assert_status(refocus_register_depth(&c, from, 0.001, to), REFOCUS_ERR_ARGUMENT);
    c.depth.fx = NAN;
    assert_status(refocus_register_depth(&c, from, 0.001, to), REFOCUS_ERR_ARGUMENT);
}

TEST(registering_onto_more_pixels_leaves_no_gaps)
{
    struct refocus_calibration c = same_cameras();
    static uint16_t from[32 * 24], to[96 * 72];

    c.colour = (struct refocus_pinhole){96, 72, 120, 120, 47.5, 35.5};
    for (int i = 0; i < 32 * 24; i++)
        from[i] = 1500;
    assert_status(refocus_register_depth(&c, from, 0.001, to), REFOCUS_OK);
    for (int y = 2; y < 70; y++)
        for (int x = 2; x < 94; x++)
            assert_int_equal(to[y * 96 + x], 1500);
}

/* The made-up scene of replay: at any size the first of five discs that has a pixel, before a wall
 * and a floor that comes nearer; the sensor misses the left edges of discs. */
TEST(made_up_depth)
{
    static uint16_t mm[960 * 720];

    rf_scene_draw((uint8_t *)mm, REFOCUS_FRAME_Z16, 2 * 960, 960, 720);
    for (int y = 0; y < 720; y++)
        for (int x = 0; x < 960; x++) {
            int expected = y > 440 ? 4000 - (y - 440) * 9 : 4000;

            for (int i = 4; i >= 0; i--) {
                const int dx = x - 100 - 190 * i, dy = y - 200 - 67 * i % 190,
                          radius = 110 - 12 * i;

                if (hypot(dx, dy) < radius && (expected == 0 || 700 + 520 * i < expected))
                    expected = dx < -radius * 0.875 ? 0 : 700 + 520 * i;
            }
            if (mm[960 * y + x] != expected)
                fail_msg("%d mm at (%d, %d), should be %d", mm[960 * y + x], x, y, expected);
        }
    rf_scene_draw((uint8_t *)mm, REFOCUS_FRAME_Z16, 2 * 96, 96, 72);
    assert_int_equal(mm[96 * 20 + 10], 700);
    assert_int_equal(mm[96 * 1 + 1], 4000);
    assert_int_equal(mm[96 * 71 + 1], 4000 - (710 - 440) * 9);
}
