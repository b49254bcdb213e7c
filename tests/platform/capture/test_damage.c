/* test_damage.c: scripts, headers, names and calibrations with one thing wrong each, and with each
 * value at the end of its range: the first are refused in words, the second are taken. */
#include "check.h"

#include <math.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>
#include <unistd.h>

#define COUNT(list) (sizeof(list) / sizeof *(list))

static int open_and_start(const char *name, struct refocus_reason *reason)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source *source = NULL;
    int status = refocus_source_open(&source, name, reason);

    config.flags = REFOCUS_SOURCE_FAST;
    if (status == REFOCUS_OK)
        status = refocus_source_start(source, &config, NULL, reason);
    refocus_source_close(&source);
    return status;
}

TEST(scripts)
{
    static const char *const wrong[] = {"at",
                                        "at 1",
                                        "at x drop",
                                        "at 1x drop",
                                        "at -1 drop",
                                        "at 1e16 drop",
                                        "at 1 nothing",
                                        "at 1 late",
                                        "at 1 late x",
                                        "at 1 late 2e9",
                                        "at 1 drop x",
                                        "at 1 format",
                                        "at 1 format x",
                                        "at 1 format YUYV",
                                        "at 1 format ,8x8",
                                        "at 1 format longer-than-any-name,8x8",
                                        "at 1 format MJPEG,8x8",
                                        "at 1 format NV99,8x8",
                                        "at 1 format YUYV,8",
                                        "at 1 format YUYV,0x8",
                                        "at 1 format YUYV,8x0",
                                        "at 1 format YUYV,99999x8",
                                        "at 1 format YUYV,8x99999",
                                        "at 1 format YUYV,8x8x8",
                                        "from",
                                        "from replay::size 8x8",
                                        "stack",
                                        "stack %d",
                                        "stack a.png 2",
                                        "stack a-%d.png 1",
                                        "stack a-%d.png 1001",
                                        "stack a-%d.png x",
                                        "lens",
                                        "lens 1",
                                        "lens x 1",
                                        "lens 2 1",
                                        "lens -1 1",
                                        "lens 0 2e6",
                                        "lens-error",
                                        "lens-error 2e6",
                                        "lens-speed 0",
                                        "jpeg",
                                        "format",
                                        "format NV99",
                                        "format MJPEG",
                                        "size",
                                        "size 8",
                                        "size 0x8",
                                        "size 8x0",
                                        "size -8x8",
                                        "size 99999x8",
                                        "size 8x99999",
                                        "size 8x8 ;size 8x8y",
                                        "fps",
                                        "fps 0",
                                        "fps 10001",
                                        "fps nan",
                                        "random 101",
                                        "random -1",
                                        "frames x",
                                        "nothing 1",
                                        "nothing",
                                        "frames"};
    static const char *const right[] = {
        "size 8x8;fps 10000;frames 1",
        "size 1x1;random 100;seed 7;frames 1",
        "start-errors 0;size 8x8",
        "lens 0 1e6;lens-error -1e6;lens-speed 1;lens-stop 0;size 8x8",
        "# all of it\n;;size 8x8 # end",
        "size 8x8;stride 16;sequence 4294967295",
        "size 8x8;at 0 drop;at 1 corrupt 3;at 2 queue-error"};
    char name[200];
    struct refocus_reason reason;

    for (size_t i = 0; i < COUNT(wrong); i++) {
        snprintf(name, sizeof name, "replay::%s", wrong[i]);
        if (open_and_start(name, &reason) != REFOCUS_ERR_FORMAT)
            fail_msg("'%s' is taken, or refused otherwise: %s", wrong[i], reason.text);
        assert_non_null(strstr(reason.text, "line "));
    }
    for (size_t i = 0; i < COUNT(right); i++) {
        snprintf(name, sizeof name, "replay::%s", right[i]);
        if (open_and_start(name, &reason) != REFOCUS_OK)
            fail_msg("'%s': %s", right[i], reason.text);
    }
    assert_status(open_and_start("replay::size 8x8;start-errors 5000", &reason), REFOCUS_ERR_IO);
    {
        char many[4096] = "replay::size 8x8";

        for (int i = 0; i <= 256; i++)
            strcat(many, ";at 1 drop");
        assert_status(open_and_start(many, &reason), REFOCUS_ERR_FORMAT);
    }
}

/* Every format of the made-up scene, whose frames end as they begin. */
TEST(scenes)
{
    for (uint32_t format = 1; format < REFOCUS_FRAME_FORMAT_COUNT; format++) {
        const struct refocus_frame *frame = NULL;
        struct refocus_source *source;
        char name[80];

        if (format == REFOCUS_FRAME_MJPEG)
            continue;
        snprintf(name, sizeof name, "replay::format %s;size 19x13;frames 2",
                 refocus_frame_format_name(format));
        source = started(name, REFOCUS_SOURCE_FAST);
        for (int i = 0; i < 2; i++) {
            assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_OK);
            assert_int_equal(frame->format, format);
            assert_int_equal(frame->width, 19);
            assert_non_null(frame->plane[0]);
            refocus_source_release(source, frame);
        }
        assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_ERR_END);
        assert_status(refocus_source_set_control(source, "brightness", 1, NULL),
                      REFOCUS_ERR_UNSUPPORTED);
        refocus_source_close(&source);
    }
}

static const char file_name[] = "damage-capture.tmp";

static void write_file(const char *bytes, size_t size)
{
    FILE *file = fopen(file_name, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

TEST(headers)
{
    static const char *const wrong[] = {"",
                                        "YUV4MPEG",
                                        "YUV4MPEG3 W8 H8\n",
                                        "YUV4MPEG2\n",
                                        "YUV4MPEG2 W8\n",
                                        "YUV4MPEG2 H8\n",
                                        "YUV4MPEG2 W0 H8\n",
                                        "YUV4MPEG2 W8 H0\n",
                                        "YUV4MPEG2 W-8 H8\n",
                                        "YUV4MPEG2 W99999 H8\n",
                                        "YUV4MPEG2 W8 H99999\n",
                                        "YUV4MPEG2 W8 H8 C411\n",
                                        "YUV4MPEG2 W8 H8 C420p10\n",
                                        "YUV4MPEG2 W8 H8",
                                        "YUV4MPEG2X W8 H8\n",
                                        "YUV4MPEG22 W8 H8\n",
                                        " YUV4MPEG2 W8 H8\n",
                                        "YUV4MPEG2 W8 H8 It\n",
                                        "YUV4MPEG2 Ib W8 H8\n",
                                        "YUV4MPEG2 W8 H8 Im C420jpeg\n",
                                        "YUV4MPEG2 W99999999999 H8\n"};
    static const char *const right[] = {"YUV4MPEG2 W8 H8\n",
                                        "YUV4MPEG2 W8 H8 F0:0\n",
                                        "YUV4MPEG2 W8 H8 F25:0\n",
                                        "YUV4MPEG2 W8 H8 F-1:1\n",
                                        "YUV4MPEG2 W8 H8 F25:1 Ip A1:1 C420jpeg XCOLORRANGE=FULL\n",
                                        "YUV4MPEG2 H8 W8 Cmono\n",
                                        "YUV4MPEG2 H8 W8 I?\n",
                                        "YUV4MPEG2 W1 H1 C420\n"};
    static const char *const bodies[] = {"FRAM",       "FRAME",     "FRAME\n",
                                         "FRAME\nabc", "NOFRAME\n", "FRAME Ixyz\nabc"};
    char name[80], bytes[256];
    struct refocus_reason reason;

    snprintf(name, sizeof name, "y4m:%s", file_name);
    for (size_t i = 0; i < COUNT(wrong); i++) {
        const int length = snprintf(bytes, sizeof bytes, "%sFRAME\n", wrong[i]);

        write_file(bytes, (size_t)length);
        if (open_and_start(name, &reason) == REFOCUS_OK)
            fail_msg("'%s' is taken", wrong[i]);
        assert_string_not_equal(reason.text, "");
    }
    for (size_t i = 0; i < COUNT(right); i++) {
        write_file(right[i], strlen(right[i]));
        if (open_and_start(name, &reason) != REFOCUS_OK)
            fail_msg("'%s': %s", right[i], reason.text);
    }
    for (size_t i = 0; i < COUNT(bodies); i++) {
        const int length = snprintf(bytes, sizeof bytes, "%s%s", right[0], bodies[i]);
        const struct refocus_frame *frame = NULL;
        struct refocus_source *source;

        write_file(bytes, (size_t)length);
        source = started(name, REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP);
        if (refocus_source_wait(source, 1000, &frame, &reason) == REFOCUS_OK)
            fail_msg("'%s' is a frame", bodies[i]);
        refocus_source_close(&source);
    }
    unlink(file_name);
}

TEST(names)
{
    static const char *const sources[] = {"raw:",
                                          "raw:x",
                                          "raw:x,NV12",
                                          "raw:x,NV12,8x8",
                                          "raw:x,NV12,8,30",
                                          "raw:x,NV12,8x8,x",
                                          "raw:x,NV99,8x8,30",
                                          "raw:x,MJPEG,8x8,30",
                                          "raw:x,NV12,0x8,30",
                                          "raw:x,NV12,8x0,30",
                                          "raw:x,NV12,99999x8,30",
                                          "raw:x,NV12,8x99999,30",
                                          "raw:x,NV12,8x8,30,9",
                                          "raw:damage-raw.tmp,NV12,8x8abc,30",
                                          "raw:damage-raw.tmp,NV12,8x8 ,30",
                                          "raw:damage-raw.tmp,NV12, 8x8,30",
                                          "raw:damage-raw.tmp,NV12,8x8x8,30",
                                          "raw:damage-raw.tmp,NV12,0000008x8,30",
                                          "raw:damage-raw.tmp,NV12,8x8,30xyz",
                                          "raw:damage-raw.tmp,NV12,8x8,nan",
                                          "raw:damage-raw.tmp,NV12,8x8,inf",
                                          "raw:damage-raw.tmp,NV12,8x8,0x10",
                                          "raw:damage-raw.tmp,NV12,8x8, 30",
                                          "raw:damage-raw.tmp,NV12,8x8,-30",
                                          "raw:damage-raw.tmp,NV12,8x8,",
                                          "y4m:",
                                          "file:",
                                          "file:none-%d-%d.png",
                                          "file:none-%s.png",
                                          "file:none-%04d.png",
                                          "file:none.png",
                                          "replay:",
                                          "replay:none.txt",
                                          "y4m:none.y4m",
                                          "nothing",
                                          "nothing:x",
                                          ":",
                                          ""};
    static const char *const sinks[] = {"raw:",        "raw:x,NV99", "raw:x,./y",
                                        "y4m:",        "none.xyz",   "none-%d-%d.png",
                                        "none-%s.png", "nothing:x",  ""};
    struct refocus_reason reason;

    for (int i = 0; i < 3; i++) {
        static const char *const right[] = {"raw:damage-raw.tmp,NV12,8x8",
                                            "raw:damage-raw.tmp,NV12,000008x8,29.97",
                                            "raw:damage-raw.tmp,NV12,8x8,1e1"};
        FILE *const file = fopen("damage-raw.tmp", "wb");

        assert_non_null(file);
        fclose(file);
        assert_status(open_and_start(right[i], &reason), REFOCUS_OK);
    }
    for (size_t i = 0; i < COUNT(sources); i++) {
        if (open_and_start(sources[i], &reason) == REFOCUS_OK)
            fail_msg("'%s' is a source", sources[i]);
        assert_string_not_equal(reason.text, "");
    }
    for (size_t i = 0; i < COUNT(sinks); i++) {
        struct refocus_sink *sink = NULL;
        int status = refocus_sink_open(&sink, sinks[i], &reason);

        if (status == REFOCUS_OK)
            status = refocus_sink_start(sink, 8, 8, 30, &reason);
        if (status == REFOCUS_OK)
            fail_msg("'%s' is a sink", sinks[i]);
        assert_string_not_equal(reason.text, "");
        refocus_sink_close(&sink, NULL);
    }
    unlink("damage-raw.tmp");
}

/* Sizes that the sink `null` takes, and sizes that none takes. */
TEST(sinks_of_any_size)
{
    static const int sizes[][2] = {
        {0, 8}, {8, 0}, {-1, 8}, {REFOCUS_MAX_SIDE + 1, 8}, {8, -1}, {8, REFOCUS_MAX_SIDE + 1}};
    static const double rates[] = {0, -1, 1e9, 30, (double)NAN, (double)INFINITY};
    static uint8_t pixels[3 * 8 * 8];
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 8, 8, 24);
    struct refocus_sink *sink = NULL;

    assert_status(refocus_sink_open(&sink, "null", NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_STATE);
    for (size_t i = 0; i < COUNT(sizes); i++)
        assert_status(refocus_sink_start(sink, sizes[i][0], sizes[i][1], 30, NULL),
                      REFOCUS_ERR_ARGUMENT);
    for (size_t i = 0; i < COUNT(rates); i++) {
        assert_status(refocus_sink_start(sink, 8, 8, rates[i], NULL), REFOCUS_OK);
        assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
    }
    image.width = 7;
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_ARGUMENT);
    image.width = 8;
    image.height = 7;
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_NV12), 1);
    assert_int_equal(refocus_sink_takes(sink, REFOCUS_FORMAT_RGB8), 1);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
}

TEST(calibrations)
{
    const struct refocus_calibration good = {.depth = {8, 6, 10, 10, 3.5, 2.5},
                                             .colour = {8, 6, 10, 10, 3.5, 2.5},
                                             .rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    static const double odd[] = {0, -1, (double)NAN, (double)INFINITY};
    static uint16_t samples[8 * 6], out[8 * 6];
    struct refocus_calibration c = good;

    for (int i = 0; i < 8 * 6; i++)
        samples[i] = (uint16_t)(1000 + i);
    assert_status(refocus_register_depth(&good, samples, 0.001, out), REFOCUS_OK);
    assert_memory_equal(out, samples, sizeof out);
    for (int which = 0; which < 2; which++) {
        struct refocus_pinhole *p = which ? &c.colour : &c.depth;
        double *const lengths[] = {&p->fx, &p->fy}, *const middles[] = {&p->cx, &p->cy};
        int32_t *const sides[] = {&p->width, &p->height};

        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 3; k++, c = good) {
                *sides[i] = (int32_t[]){0, -1, REFOCUS_MAX_SIDE + 1}[k];
                assert_status(refocus_register_depth(&c, samples, 0.001, out),
                              REFOCUS_ERR_ARGUMENT);
            }
            for (size_t k = 0; k < COUNT(odd); k++, c = good) {
                *lengths[i] = odd[k];
                assert_status(refocus_register_depth(&c, samples, 0.001, out),
                              REFOCUS_ERR_ARGUMENT);
            }
            for (size_t k = 2; k < COUNT(odd); k++, c = good) {
                *middles[i] = odd[k];
                assert_status(refocus_register_depth(&c, samples, 0.001, out),
                              REFOCUS_ERR_ARGUMENT);
            }
        }
    }
    for (size_t k = 0; k < COUNT(odd); k++, c = good) {
        assert_status(refocus_register_depth(&good, samples, odd[k], out), REFOCUS_ERR_ARGUMENT);
        c.rotation[8] = k < 2 ? 1 : odd[k];
        c.translation_m[0] = k < 2 ? 0 : odd[k];
        assert_status(refocus_register_depth(&c, samples, 0.001, out),
                      k < 2 ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
    }
    /* Far to each side, behind the camera, and farther than 65535 units: nothing is written. */
    for (int i = 0; i < 7; i++, c = good) {
        c.translation_m[i / 2 % 3] = i == 6 ? 1e9 : i % 2 ? 1e7 : -1e7;
        if (i == 6)
            c.translation_m[0] = 0, c.translation_m[2] = 1e9;
        assert_status(refocus_register_depth(&c, samples, 0.001, out), REFOCUS_OK);
        for (int k = 0; k < 8 * 6; k++)
            assert_int_equal(out[k], 0);
    }
    /* A colour camera of few pixels sees many samples in each: the nearest one counts. */
    c.colour = (struct refocus_pinhole){2, 2, 2.5, 2.5, 0.5, 0.5};
    assert_status(refocus_register_depth(&c, samples, 0.001, out), REFOCUS_OK);
    assert_int_equal(out[0], 1000);
}
