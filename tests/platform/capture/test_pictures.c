/* test_pictures.c: the source `file:`: depth as frames, pictures that come in time, change their
 * size, are damaged or run out; and each allocation of sources and sinks of files fails once. */
#include "check.h"

#include <unistd.h>

#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>

#include "failing.h"

static struct refocus_reason reason;

static void write_file(const char *name, const char *head, const void *samples, size_t size)
{
    FILE *const file = fopen(name, "wb");

    assert_non_null(file);
    assert_true(fputs(head, file) >= 0);
    assert_int_equal(fwrite(samples, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static const uint8_t samples[96] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

/* A PPM of 4 x 2, or of 2 x 4. */
static void write_picture(int number, int tall)
{
    char name[32];

    snprintf(name, sizeof name, "p-%d.ppm", number);
    write_file(name, tall ? "P6 2 4 255\n" : "P6 4 2 255\n", samples, 24);
}

TEST(depth_of_codes)
{
    const struct refocus_frame *frame;
    struct refocus_source *source;

    write_file("depth8.pgm", "P5 4 2 255\n", samples, 8);
    write_file("depth16.pgm", "P5 4 2 65535\n", samples, 16);
    write_file("depth.pfm", "Pf 4 2 -1\n", samples, 32);
    source = started("file:depth8.pgm", REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_DEPTH);
    assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
    assert_int_equal(frame->format, REFOCUS_FRAME_GREY);
    assert_memory_equal(frame->plane[0], samples, 4);
    assert_memory_equal(frame->plane[0] + frame->stride[0], samples + 4, 4);
    assert_true(frame->flags & REFOCUS_FRAME_STILL);
    refocus_source_release(source, frame);
    refocus_source_close(&source);
    source = started("file:depth16.pgm", REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_DEPTH);
    assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
    assert_int_equal(frame->format, REFOCUS_FRAME_Y16);
    assert_int_equal(frame->width, 4);
    assert_int_equal(frame->height, 2);
    assert_int_equal(((const uint16_t *)(const void *)frame->plane[0])[1], 3 << 8 | 4);
    refocus_source_close(&source);
    assert_status(refocus_source_open(&source, "file:depth.pfm", &reason), REFOCUS_OK);
    {
        struct refocus_source_config config = refocus_source_config_default();

        config.flags = REFOCUS_SOURCE_DEPTH;
        assert_status(refocus_source_start(source, &config, NULL, &reason),
                      REFOCUS_ERR_UNSUPPORTED);
        assert_non_null(strstr(reason.text, "floats"));
    }
    refocus_source_close(&source);
}

/* A picture comes when it is due and no sooner, and its time is told. */
TEST(pictures_in_time)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source_mode mode = refocus_source_mode_default();
    const struct refocus_frame *frame;
    struct refocus_source *source;
    int64_t first;

    write_picture(1, 0);
    write_picture(2, 0);
    unlink("p-0.ppm");
    unlink("p-3.ppm");
    config.fps = 4;
    assert_status(refocus_source_open(&source, "file:p-%d.ppm", &reason), REFOCUS_OK);
    assert_status(refocus_source_get_mode(source, 0, &mode), REFOCUS_OK);
    assert_int_equal(mode.format, REFOCUS_FRAME_RGB24);
    assert_status(refocus_source_get_mode(source, 1, &mode), REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_start(source, &config, &mode, &reason), REFOCUS_OK);
    assert_true(mode.fps == 4);
    assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
    assert_true(frame->flags & REFOCUS_FRAME_MONOTONIC);
    assert_false(frame->flags & (REFOCUS_FRAME_STILL | REFOCUS_FRAME_CHANGED));
    first = frame->timestamp_ns;
    refocus_source_release(source, frame);
    assert_status(refocus_source_wait(source, 1, &frame, &reason), REFOCUS_ERR_TIMEOUT);
    assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
    assert_int_equal(frame->timestamp_ns - first, 250000000);
    assert_int_equal(frame->sequence, 1);
    refocus_source_release(source, frame);
    assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_ERR_END);
    assert_status(refocus_source_restart(source, NULL, &reason), REFOCUS_OK);
    assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_OK);
    assert_int_equal(frame->sequence, 0);
    refocus_source_interrupt(source);
    for (int i = 0; i < 2; i++)
        assert_status(refocus_source_wait(source, 1000, &frame, &reason), REFOCUS_ERR_CANCELLED);
    refocus_source_close(&source);
}

/* Sizes that change are told, damage is an error of its picture alone, the end is the beginning
 * where that is asked for, and frames are out until they come back. */
TEST(pictures_change)
{
    const struct refocus_frame *frame, *kept[32];
    struct refocus_source *source;
    int n = 0, status;

    for (int i = 0; i < 4; i++)
        write_picture(i, i == 2);
    write_file("p-1.ppm", "P6 4 2 255\n", samples, 5);
    unlink("p-4.ppm");
    source = started("file:p-%d.ppm", REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP);
    for (int round = 0; round < 2; round++) {
        assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
        assert_false(frame->flags & (REFOCUS_FRAME_CHANGED | REFOCUS_FRAME_MONOTONIC));
        refocus_source_release(source, frame);
        assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_ERR_FORMAT);
        assert_ptr_equal(strstr(reason.text, "p-1.ppm: "), reason.text);
        write_picture(1, 0);
        assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
        refocus_source_release(source, frame);
        for (int i = 2; i < 4; i++) {
            assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
            assert_true(frame->flags & REFOCUS_FRAME_CHANGED);
            assert_int_equal(frame->height, i == 2 ? 4 : 2);
            refocus_source_release(source, frame);
        }
        write_file("p-1.ppm", "P6 4 2 255\n", samples, 5);
    }
    write_picture(1, 0);
    while ((status = refocus_source_wait(source, 0, &kept[n], &reason)) == REFOCUS_OK && n < 31)
        n++;
    assert_status(status, REFOCUS_ERR_STATE);
    assert_true(n >= 2);
    refocus_source_release(source, kept[0]);
    assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
    refocus_source_stop(source);
    for (int i = 0; i < 4; i++) { /* gone while it waits */
        char name[32];

        snprintf(name, sizeof name, "p-%d.ppm", i);
        unlink(name);
    }
    assert_status(refocus_source_start(source, NULL, NULL, &reason), REFOCUS_ERR_IO);
    refocus_source_close(&source);
}

/* A number that is missing is no end where another one follows, up to a hundred farther on. */
TEST(a_gap_is_told)
{
    const struct refocus_frame *frame;
    struct refocus_source *source;

    for (int i = 0; i < 2; i++)
        write_picture(i, 0);
    for (int far = 3; far <= 103; far += 50) {
        const int status = far < 103 ? REFOCUS_ERR_FORMAT : REFOCUS_ERR_END;

        write_picture(far, 0);
        source = started("file:p-%d.ppm", REFOCUS_SOURCE_FAST);
        for (int i = 0; i < 2; i++) {
            assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
            refocus_source_release(source, frame);
        }
        assert_status(refocus_source_wait(source, 0, &frame, &reason), status);
        if (status == REFOCUS_ERR_FORMAT)
            assert_non_null(strstr(reason.text, "p-2.ppm is missing"));
        refocus_source_close(&source);
        remove(far == 3 ? "p-3.ppm" : far == 53 ? "p-53.ppm" : "p-103.ppm");
    }
}

/* The lowest number that is there is the first one; a folder may hold other things, too. */
TEST(numbers_begin_anywhere)
{
    static const char *const names[] = {"n-x%04d.ppm", "n-0001.ppm", "n-00002.ppm", "n-x%3d.ppm"};
    static const int first[] = {7, 100, 2147483646};
    const struct refocus_frame *frame;
    struct refocus_source *source;
    char name[2][32];

    for (int i = 0; i < 4; i++)
        write_file(names[i], "P6 9 9 255\n", samples, 1);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            snprintf(name[k], sizeof name[k], "n-x%04d.ppm", first[i] + k);
            write_file(name[k], "P6 4 2 255\n", samples, 24);
        }
        source = started("file:n-x%04d.ppm", REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP);
        for (int k = 0; k < 4; k++) {
            assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
            assert_int_equal(frame->width, 4);
            refocus_source_release(source, frame);
        }
        refocus_source_close(&source);
        source = started("file:n-x%04d.ppm", REFOCUS_SOURCE_FAST);
        for (int k = 0; k < 3; k++) {
            assert_status(refocus_source_wait(source, 0, &frame, &reason),
                          k < 2 ? REFOCUS_OK : REFOCUS_ERR_END);
            refocus_source_release(source, k < 2 ? frame : NULL);
        }
        refocus_source_close(&source);
        remove(name[0]);
        remove(name[1]);
    }
    assert_status(refocus_source_open(&source, "file:n-x%04d.ppm", &reason), REFOCUS_ERR_GONE);
    assert_string_equal(reason.text, "n-x%04d.ppm: no such file");
    for (int i = 0; i < 4; i++)
        remove(names[i]);
}

/* A map that is missing or damaged is a frame that says so, and the next ones come. */
TEST(maps_are_left_out)
{
    static const char *const why[] = {NULL, "m-1.pgm: ", "m-2.pgm is missing", NULL};
    struct refocus_source_counters counters = refocus_source_counters_default();
    struct refocus_converter *converter;
    const struct refocus_frame *frame;
    struct refocus_source *source;
    uint16_t converted[8];

    write_file("m-0.pgm", "P5 4 2 255\n", samples, 8);
    write_file("m-1.pgm", "P5 4 2 255\n", samples, 7);
    write_file("m-3.pgm", "P5 4 2 255\n", samples, 8);
    remove("m-2.pgm");
    source = started("file:m-%d.pgm", REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_DEPTH);
    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (int i = 0; i < 4; i++) {
        assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_OK);
        assert_int_equal(frame->sequence, i);
        assert_int_equal(frame->flags, why[i] ? REFOCUS_FRAME_CORRUPT : 0);
        assert_int_equal(!frame->plane[0], why[i] != NULL);
        assert_status(refocus_convert_samples(converter, frame, converted, NULL),
                      why[i] ? REFOCUS_ERR_UNSUPPORTED : REFOCUS_OK);
        if (why[i])
            assert_ptr_equal(strstr(reason.text, why[i]), reason.text);
        refocus_source_release(source, frame);
    }
    assert_status(refocus_source_wait(source, 0, &frame, &reason), REFOCUS_ERR_END);
    refocus_source_get_counters(source, &counters);
    assert_true(counters.corrupt == 2 && counters.frames == 4 && counters.released == 4);
    refocus_converter_destroy(&converter);
    refocus_source_close(&source);
}

/* Every allocation -------------------------------------------------------------------- */

/* Opens, starts and takes two frames. */
static int read_some(const char *name)
{
    struct refocus_source *source = NULL;
    const struct refocus_frame *frame;
    int status = refocus_source_open(&source, name, &reason);

    assert_true(!source == (status != REFOCUS_OK));
    if (status == REFOCUS_OK)
        status = refocus_source_start(source, NULL, NULL, &reason);
    for (int i = 0; i < 2 && status == REFOCUS_OK; i++) {
        status = refocus_source_wait(source, 1000, &frame, &reason);
        if (status == REFOCUS_OK)
            refocus_source_release(source, frame);
    }
    refocus_source_close(&source);
    return status;
}

static int write_some(const char *name)
{
    static uint8_t pixels[24];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 4, 2, 12);
    struct refocus_sink *sink = NULL;
    int status = refocus_sink_open(&sink, name, &reason), end;

    assert_true(!sink == (status != REFOCUS_OK));
    if (status == REFOCUS_OK)
        status = refocus_sink_start(sink, 4, 2, 25, &reason);
    for (int i = 0; i < 2 && status == REFOCUS_OK; i++)
        status = refocus_sink_write(sink, &image, &reason);
    end = refocus_sink_close(&sink, &reason);
    return status == REFOCUS_OK ? end : status;
}

TEST(every_allocation)
{
    static const char *const names[] = {
        "y4m:m.y4m",
        "raw:m.rgb",
        "m-%d.ppm",
        "file:m-%d.ppm",
        "raw:m.rgb,RGB24,4x2",
        "y4m:m.y4m",
        "replay::size 8x4;frames 3",
        "replay::from y4m:m.y4m;frames 2",
    };
    enum { SINKS = 3 };

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        int (*const act)(const char *) = i < SINKS ? write_some : read_some;
        const int files = count_entries("fd");
        long calls, live;

        failing.fail_at = 0;
        assert_status(act(names[i]), REFOCUS_OK); /* some is kept for good, from here on */
        live = failing.live;
        failing.calls = 0;
        assert_status(act(names[i]), REFOCUS_OK);
        assert_int_equal(failing.live, live);
        calls = failing.calls;
        assert_true(calls > 1);
        for (long at = 1; at <= calls; at++) {
            failing.calls = 0;
            failing.fail_at = at;
            assert_status(act(names[i]), REFOCUS_ERR_MEMORY);
            failing.fail_at = 0;
            assert_int_equal(failing.live, live);
            assert_int_equal(count_entries("fd"), files);
        }
        assert_status(act(names[i]), REFOCUS_OK);
    }
}

static int always(void *user)
{
    (void)user;
    return 1;
}

/* A picture of a sequence that is cancelled leaves no file, and the next one that is not has the
 * next number. */
TEST(a_cancelled_picture)
{
    static uint8_t rgb[3 * 16 * 16];
    const struct refocus_image picture =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, 16, 16, 3 * 16);
    struct refocus_sink *sink;

    unlink("cancelled-0.ppm");
    unlink("cancelled-1.ppm");
    assert_status(refocus_sink_open(&sink, "cancelled-%d.ppm", &reason), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, 16, 16, 25, &reason), REFOCUS_OK);
    assert_status(refocus_sink_set_cancelled(sink, always, NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &picture, &reason), REFOCUS_ERR_CANCELLED);
    assert_int_equal(access("cancelled-0.ppm", F_OK), -1);
    assert_status(refocus_sink_set_cancelled(sink, NULL, NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &picture, &reason), REFOCUS_OK);
    assert_int_equal(access("cancelled-0.ppm", F_OK), -1);
    assert_int_equal(access("cancelled-1.ppm", F_OK), 0);
    refocus_sink_close(&sink, &reason);
    unlink("cancelled-1.ppm");
}
