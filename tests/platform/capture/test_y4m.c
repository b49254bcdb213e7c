/* test_y4m.c: what the header of a y4m says goes over into that of a y4m that is made of it, and
 * when a stream begins. */
#include "check.h"

#include <unistd.h>
#include <refocus/platform/sink.h>

/* The header of a stream that is made of one with this header, of pictures of such a format. */
static void check_header(const char *in, uint32_t format, const char *out)
{
    static uint8_t memory[3 * 4 * 4];
    struct refocus_image image = refocus_image_planar(format, memory, 4, 4);
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source = NULL;
    struct refocus_sink *sink = NULL;
    char header[200];
    FILE *file;

    snprintf(header, sizeof header, "YUV4MPEG2 W4 H4 %s\n", in);
    file = fopen("in.y4m", "wb");
    assert_non_null(file);
    assert_true(fputs(header, file) >= 0);
    assert_int_equal(fclose(file), 0);
    assert_status(refocus_source_open(&source, "y4m:in.y4m", NULL), REFOCUS_OK);
    assert_status(refocus_source_start(source, NULL, &mode, NULL), REFOCUS_OK);
    assert_status(refocus_sink_open(&sink, "y4m:out.y4m", NULL), REFOCUS_OK);
    assert_status(refocus_sink_set_mode(sink, &mode), REFOCUS_OK);
    assert_status(refocus_sink_start_image(sink, &image, mode.fps, NULL), REFOCUS_OK);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    refocus_source_close(&source);
    file = fopen("out.y4m", "rb");
    assert_non_null(file);
    assert_non_null(fgets(header, sizeof header, file));
    fclose(file);
    header[strcspn(header, "\n")] = '\0';
    assert_string_equal(strstr(header, " F") + 1, out);
}

TEST(y4m_keeps_its_header)
{
    static const char *const rates[] = {"30000:1001", "24000:1001", "60000:1001",   "25:1",
                                        "50:1",       "1:5000",     "10000:1",      "2997:100",
                                        "1:1",        "15:2",       "999983:999979"};
    char in[40], out[80];

    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        snprintf(in, sizeof in, "F%s", rates[i]);
        snprintf(out, sizeof out, "F%s Ip A1:1 C420jpeg XCOLORRANGE=LIMITED", rates[i]);
        check_header(in, REFOCUS_FORMAT_I420, out);
    }
    check_header("F30:1 A128:117 C420mpeg2", REFOCUS_FORMAT_I420,
                 "F30:1 Ip A128:117 C420mpeg2 XCOLORRANGE=LIMITED");
    check_header("A10:11 C420paldv XCOLORRANGE=FULL", REFOCUS_FORMAT_NV12,
                 "F30:1 Ip A10:11 C420paldv XCOLORRANGE=LIMITED");
    check_header("A10:11 C422", REFOCUS_FORMAT_YUYV, "F30:1 Ip A10:11 C422 XCOLORRANGE=LIMITED");
    check_header("C420 A0:0", REFOCUS_FORMAT_I420, "F30:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED");
    check_header("C420 A-1:2", REFOCUS_FORMAT_I420, "F30:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED");
    /* R, G and B become means of four pixels. */
    check_header("A4:3 C420mpeg2", REFOCUS_FORMAT_RGB8,
                 "F30:1 Ip A4:3 C420jpeg XCOLORRANGE=LIMITED");
}

/* The old contents are there until a frame is announced, and no file is left empty. */
TEST(nothing_is_lost_before_it_begins)
{
    static const char *const names[] = {"y4m:begun.tmp", "raw:begun.tmp,NV12"};
    struct refocus_sink *sink = NULL;

    for (int i = 0; i < 2; i++) {
        char text[8] = "";
        FILE *file;

        remove("begun.tmp");
        assert_status(refocus_sink_open(&sink, names[i], NULL), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
        assert_int_equal(access("begun.tmp", F_OK), -1);
        file = fopen("begun.tmp", "wb");
        assert_non_null(file);
        assert_true(fputs("precious", file) >= 0);
        fclose(file);
        assert_status(refocus_sink_open(&sink, names[i], NULL), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
        assert_status(refocus_sink_open(&sink, names[i], NULL), REFOCUS_OK);
        file = fopen("begun.tmp", "rb");
        assert_int_equal(fread(text, 1, sizeof text, file), 8);
        assert_memory_equal(text, "precious", 8);
        assert_status(refocus_sink_start(sink, 4, 4, 30, NULL), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
        rewind(file);
        assert_int_equal(fread(text, 1, sizeof text, file), i == 0 ? 8 : 0);
        assert_memory_equal(text, i == 0 ? "YUV4MPEG" : "precious", 8);
        fclose(file);
    }
    remove("begun.tmp");
}
