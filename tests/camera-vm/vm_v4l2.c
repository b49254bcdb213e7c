/* vm_v4l2.c: sources on a vivid camera at /dev/videoNODE, with every format and fault.
 *
 * usage: vm-v4l2 NODE [CYCLES]
 * The faults are all that the driver can be told to have. With CYCLES it only opens, starts, stops
 * and closes the camera so many times. It runs where the driver is, in the
 * virtual machine. */
#include <pthread.h>
#include <unistd.h>
#include <refocus/refocus.h>
#include <refocus/platform/convert.h>

#include "check.h"
#include "../clock.h"

enum { WIDTH = 320, HEIGHT = 180 };
static char node[64];
static uint8_t reference[WIDTH * HEIGHT * 3];

#define assert_gives(expression, status)                                                           \
    do {                                                                                           \
        const int got_ = (expression);                                                             \
        if (got_ != (status))                                                                      \
            fail_msg("%s gives %d (%s): %s", #expression, got_, refocus_strerror(got_),            \
                     reason.text);                                                                 \
    } while (0)
static struct refocus_reason reason;

static struct refocus_source *opened(void)
{
    struct refocus_source *source = NULL;

    assert_gives(refocus_source_open(&source, node, &reason), REFOCUS_OK);
    return source;
}

static struct refocus_source *streaming(uint32_t format, uint32_t flags)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source *source = opened();
    struct refocus_source_mode mode = refocus_source_mode_default();

    config.format = format;
    config.width = WIDTH;
    config.height = HEIGHT;
    config.fps = 60;
    config.flags = flags;
    assert_gives(refocus_source_start(source, &config, &mode, &reason), REFOCUS_OK);
    assert_int_equal(mode.width, WIDTH);
    assert_int_equal(mode.height, HEIGHT);
    return source;
}

static const struct refocus_frame *next(struct refocus_source *source)
{
    const struct refocus_frame *frame = NULL;

    assert_gives(refocus_source_wait(source, 3000, &frame, &reason), REFOCUS_OK);
    return frame;
}

static void take(struct refocus_source *source, int count)
{
    for (int i = 0; i < count; i++)
        refocus_source_release(source, next(source));
}

/* Sets a control by another descriptor, as another program would. */
static void inject(const char *control, double value)
{
    struct refocus_source *second = opened();

    assert_gives(refocus_source_set_control(second, control, value, &reason), REFOCUS_OK);
    refocus_source_close(&second);
}

static struct refocus_source_counters counters(struct refocus_source *source)
{
    struct refocus_source_counters c = refocus_source_counters_default();

    refocus_source_get_counters(source, &c);
    return c;
}

/* Stopped, every buffer that came has gone back, or is told as lost. */
static void finish(struct refocus_source *source, uint64_t lost)
{
    struct refocus_source_counters c;

    refocus_source_stop(source);
    c = counters(source);
    assert_int_equal(c.dequeued, c.queued + c.lost);
    assert_int_equal(c.frames, c.released);
    assert_int_equal(c.lost, lost);
    refocus_source_close(&source);
}

/* Formats ----------------------------------------------------------------------------------- */

static void capture(uint32_t format, uint32_t flags, uint8_t *rgb)
{
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, WIDTH, HEIGHT, WIDTH * 3);
    struct refocus_converter *converter = NULL;
    struct refocus_source *source = streaming(format, flags);

    assert_int_equal(refocus_converter_create(&converter), REFOCUS_OK);
    take(source, 2);
    for (int i = 0; i < 2; i++) {
        const struct refocus_frame *frame = next(source);

        assert_int_equal(frame->format, format);
        assert_true(frame->flags & REFOCUS_FRAME_MONOTONIC);
        assert_int_equal(frame->dmabuf[0] >= 0, (flags & REFOCUS_SOURCE_DMABUF) != 0);
        assert_gives(refocus_convert_rgb8(converter, frame, &image, &reason), REFOCUS_OK);
        refocus_source_release(source, frame);
    }
    refocus_converter_destroy(&converter);
    finish(source, 0);
}

/* Refocused, the picture stays where the focus is and changes where it is not. */
static void check_refocus(const uint8_t *rgb, const char *name)
{
    static uint16_t disparity[WIDTH * HEIGHT];
    static uint8_t out[WIDTH * HEIGHT * 3];
    const struct refocus_disparity map = refocus_disparity16(disparity, WIDTH, HEIGHT, WIDTH * 2);
    struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, (void *)(uintptr_t)rgb, WIDTH, HEIGHT, WIDTH * 3);
    struct refocus_image result =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, WIDTH, HEIGHT, WIDTH * 3);
    struct refocus_renderer_params make = refocus_renderer_params_default(WIDTH, HEIGHT, 8);
    struct refocus_render_params params = refocus_render_params_default(1, 8);
    struct refocus_renderer *renderer = NULL;
    int changed = 0;

    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            disparity[y * WIDTH + x] = x < WIDTH / 2 ? 65535 : 0;
    params.rays = 16;
    assert_int_equal(refocus_renderer_create(&renderer, &make), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &map), REFOCUS_OK);
    assert_int_equal(refocus_render(renderer, &params, &result), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    for (int y = 0; y < HEIGHT; y++) {
        const size_t row = (size_t)y * WIDTH * 3, half = WIDTH / 2 * 3;

        if (memcmp(out + row, rgb + row, half - 24) != 0)
            fail_msg("%s: row %d changed where it is in focus", name, y);
        changed += memcmp(out + row + half + 24, rgb + row + half + 24, half - 24) != 0;
    }
    if (changed < HEIGHT / 2)
        fail_msg("%s: %d rows are blurred, of %d", name, changed, HEIGHT);
}

/* Every format shows equal bars, but for the loss of chroma beside edges. */
static void check_picture(const uint8_t *rgb, const char *name, int grey)
{
    int off = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t *a = reference + 3 * i, *b = rgb + 3 * i;
        const int luma = (299 * a[0] + 587 * a[1] + 114 * a[2]) / 1000;
        int worst = 0;

        for (int c = 0; c < 3; c++) {
            const int distance = abs((grey ? luma : a[c]) - b[c]);
            worst = distance > worst ? distance : worst;
        }
        off += worst > (grey ? 24 : 6);
    }
    if (off > WIDTH * HEIGHT / 20)
        fail_msg("%s: %d of %d pixels differ from RGB24", name, off, WIDTH * HEIGHT);
}

static void every_format_is_captured(void **state)
{
    static uint8_t rgb[WIDTH * HEIGHT * 3];
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source;
    uint32_t offered = 0;

    (void)state;
    inject("osd_text_mode", 2);
    source = opened();
    for (int i = 0; refocus_source_get_mode(source, i, &mode) == REFOCUS_OK; i++)
        offered |= 1u << mode.format;
    refocus_source_close(&source);
    for (uint32_t format = 1; format < REFOCUS_FRAME_FORMAT_COUNT; format++)
        if (format != REFOCUS_FRAME_MJPEG && format != REFOCUS_FRAME_Z16)
            assert_true(offered >> format & 1); /* vivid has all but these two */
    capture(REFOCUS_FRAME_RGB24, 0, reference);
    for (uint32_t format = 1; format < REFOCUS_FRAME_FORMAT_COUNT; format++) {
        const char *name = refocus_frame_format_name(format);

        if (!(offered >> format & 1))
            continue;
        for (uint32_t flags = 0; flags <= REFOCUS_SOURCE_DMABUF; flags += REFOCUS_SOURCE_DMABUF) {
            memset(rgb, 0, sizeof rgb);
            capture(format, flags, rgb);
            check_picture(rgb, name, format >= REFOCUS_FRAME_GREY);
        }
        check_refocus(rgb, name);
        printf("captured and refocused: %s\n", name);
    }
}

static void what_it_has_not_is_refused(void **state)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source *source = opened();

    (void)state;
    config.format = REFOCUS_FRAME_Z16;
    assert_gives(refocus_source_start(source, &config, NULL, &reason), REFOCUS_ERR_UNSUPPORTED);
    assert_gives(refocus_source_set_control(source, "no_such_control", 1, &reason),
                 REFOCUS_ERR_ARGUMENT);
    assert_gives(refocus_source_set_control(source, "brightness", 130, &reason), REFOCUS_OK);
    assert_gives(refocus_source_set_control(source, "brightness", 128, &reason), REFOCUS_OK);
    refocus_source_close(&source);
}

/* Faults ------------------------------------------------------------------------------------ */

static void missing_and_wrong_devices(void **state)
{
    struct refocus_source *source = NULL;

    (void)state;
    assert_gives(refocus_source_open(&source, "v4l2:/dev/video77", &reason), REFOCUS_ERR_GONE);
    assert_gives(refocus_source_open(&source, "v4l2:/dev/null", &reason), REFOCUS_ERR_UNSUPPORTED);
    assert_gives(refocus_source_open(&source, "v4l2:/etc/passwd", &reason),
                 REFOCUS_ERR_UNSUPPORTED);
    assert_gives(refocus_source_open(&source, "v4l2:1", &reason), REFOCUS_ERR_UNSUPPORTED);
    assert_null(source);
}

static void a_busy_device(void **state)
{
    struct refocus_source *first = streaming(REFOCUS_FRAME_NV12, 0), *second = opened();

    (void)state;
    take(first, 2);
    assert_gives(refocus_source_start(second, NULL, NULL, &reason), REFOCUS_ERR_BUSY);
    assert_non_null(strstr(reason.text, "another program"));
    take(first, 2);
    refocus_source_close(&second);
    finish(first, 0);
}

static void corrupt_buffers_are_flagged(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);
    int corrupt = 0;

    (void)state;
    take(source, 2);
    inject("inject_v4l2_buf_flag_error", 1);
    for (int i = 0; i < 10; i++) {
        const struct refocus_frame *frame = next(source);

        corrupt += (frame->flags & REFOCUS_FRAME_CORRUPT) != 0;
        refocus_source_release(source, frame);
    }
    assert_int_equal(corrupt, 1);
    finish(source, 0);
}

static void dropped_buffers_are_counted(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);
    const struct refocus_frame *frame;

    (void)state;
    inject("percentage_of_dropped_buffers", 50);
    take(source, 20);
    assert_true(counters(source).dropped >= 5);
    inject("percentage_of_dropped_buffers", 100);
    while (refocus_source_wait(source, 300, &frame, &reason) == REFOCUS_OK)
        refocus_source_release(source, frame);
    assert_gives(refocus_source_wait(source, 100, &frame, &reason), REFOCUS_ERR_TIMEOUT);
    inject("percentage_of_dropped_buffers", 0);
    take(source, 2);
    finish(source, 0);
}

static void a_queue_error_loses_nothing(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);

    (void)state;
    take(source, 2);
    for (int i = 0; i < 6; i++) {
        inject("inject_vidioc_qbuf_error", 1);
        take(source, 2);
    }
    finish(source, 0);
}

static void a_stream_on_error_passes(void **state)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_source *source = opened();

    (void)state;
    inject("inject_vidioc_streamon_error", 1);
    assert_gives(refocus_source_start(source, &config, NULL, &reason), REFOCUS_ERR_IO);
    assert_gives(refocus_source_restart(source, NULL, &reason), REFOCUS_OK);
    take(source, 2);
    refocus_source_stop(source);
    inject("inject_vidioc_reqbufs_error", 1);
    assert_gives(refocus_source_restart(source, NULL, &reason), REFOCUS_ERR_IO);
    assert_gives(refocus_source_restart(source, NULL, &reason), REFOCUS_OK);
    take(source, 2);
    finish(source, 0);
}

/* Frames, until wait says that the device has failed or gone. */
static int until_fault(struct refocus_source *source)
{
    const struct refocus_frame *frame;
    int status;

    for (int i = 0; i < 50; i++) {
        status = refocus_source_wait(source, 500, &frame, &reason);
        if (status != REFOCUS_OK)
            return status;
        refocus_source_release(source, frame);
    }
    return REFOCUS_OK;
}

/* Milliseconds until frames come again. */
static int64_t recover(struct refocus_source *source)
{
    const double begin = now_ms();

    while (refocus_source_restart(source, NULL, &reason) != REFOCUS_OK) {
        if (now_ms() - begin > 5000)
            fail_msg("no recovery: %s", reason.text);
        sleep_ms(50);
    }
    take(source, 1);
    return (int64_t)(now_ms() - begin);
}

static void a_fatal_error_is_recovered_from(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);
    int64_t ms;

    (void)state;
    take(source, 2);
    inject("inject_fatal_streaming_error", 1);
    assert_gives(until_fault(source), REFOCUS_ERR_IO);
    ms = recover(source);
    printf("recovered from a fatal error in %d ms\n", (int)ms);
    assert_true(ms < 1000);
    take(source, 3);
    finish(source, 0);
}

static void an_unplugged_device_returns(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);
    const struct refocus_frame *held;
    int64_t ms;

    (void)state;
    take(source, 2);
    held = next(source);
    inject("disconnect", 1);
    assert_gives(until_fault(source), REFOCUS_ERR_GONE);
    assert_true(held->plane[0][0] > 0); /* the frame's memory is still there */
    refocus_source_release(source, held);
    ms = recover(source);
    printf("recovered from a disconnection in %d ms\n", (int)ms);
    assert_true(ms < 1000);
    take(source, 3);
    finish(source, 1); /* the one that was held has nowhere to go */
    /* Unplugged while it does not stream. */
    source = opened();
    inject("disconnect", 1);
    assert_gives(refocus_source_start(source, NULL, NULL, &reason), REFOCUS_ERR_GONE);
    assert_true(recover(source) < 1000);
    finish(source, 0);
}

static void the_sequence_may_wrap(void **state)
{
    struct refocus_source *source;

    (void)state;
    inject("wrap_sequence_number", 1);
    source = streaming(REFOCUS_FRAME_NV12, 0);
    take(source, 140);
    assert_true(counters(source).dropped < 140);
    finish(source, 0);
    inject("wrap_sequence_number", 0);
}

/* The cable of an HDMI input is pulled: the driver tells, and the stream begins anew. */
static void another_signal_restarts_it(void **state)
{
    struct refocus_source *source;
    char command[128];

    (void)state;
    snprintf(command, sizeof command, "v4l2-ctl -d%s -i 1 >/dev/null", node + strlen("v4l2:"));
    assert_int_equal(system(command), 0);
    source = opened();
    assert_gives(refocus_source_start(source, NULL, NULL, &reason), REFOCUS_OK);
    take(source, 2);
    inject("dv_timings_signal_mode", 1);
    assert_gives(until_fault(source), REFOCUS_ERR_IO);
    assert_non_null(strstr(reason.text, "signal"));
    assert_true(recover(source) < 1000);
    inject("dv_timings_signal_mode", 0);
    assert_gives(until_fault(source), REFOCUS_ERR_IO);
    assert_true(recover(source) < 1000);
    finish(source, 0);
    command[strlen(command) - strlen("1 >/dev/null")] = '0';
    assert_int_equal(system(command), 0);
}

static void *interrupt(void *source)
{
    sleep_ms(100);
    refocus_source_interrupt(source);
    return NULL;
}

static void another_thread_stops_it(void **state)
{
    struct refocus_source *source = streaming(REFOCUS_FRAME_NV12, 0);
    const struct refocus_frame *frame;
    pthread_t thread;
    double begin;

    (void)state;
    take(source, 1);
    inject("percentage_of_dropped_buffers", 100);
    begin = now_ms();
    assert_int_equal(pthread_create(&thread, NULL, interrupt, source), 0);
    while (refocus_source_wait(source, 20000, &frame, &reason) == REFOCUS_OK)
        refocus_source_release(source, frame);
    assert_gives(refocus_source_wait(source, 20000, &frame, &reason), REFOCUS_ERR_CANCELLED);
    assert_true(now_ms() - begin < 5000);
    pthread_join(thread, NULL);
    inject("percentage_of_dropped_buffers", 0);
    finish(source, 0);
}

static int cycles = 60;

/* Every second one by DMA-BUF, every tenth with a frame that is out. */
static void cycles_leak_nothing(void **state)
{
    const double begin = now_ms();
    int fds = 0, threads = 0, maps = 0;

    (void)state;
    for (int i = 0; i < cycles; i++) {
        struct refocus_source *source =
            streaming(REFOCUS_FRAME_NV12, i & 1 ? REFOCUS_SOURCE_DMABUF : 0);

        if (i % 10 == 0)
            next(source);
        refocus_source_close(&source);
        if (i == 20) {
            fds = count_entries("fd");
            threads = count_entries("task");
            maps = count_mappings();
        }
    }
    assert_int_equal(count_entries("fd"), fds);
    assert_int_equal(count_entries("task"), threads);
    assert_true(count_mappings() <= maps + 2);
    printf("cycles: %d in %d s, nothing left open\n", cycles, (int)((now_ms() - begin) / 1000));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_captured),
        cmocka_unit_test(what_it_has_not_is_refused),
        cmocka_unit_test(missing_and_wrong_devices),
        cmocka_unit_test(a_busy_device),
        cmocka_unit_test(corrupt_buffers_are_flagged),
        cmocka_unit_test(dropped_buffers_are_counted),
        cmocka_unit_test(a_queue_error_loses_nothing),
        cmocka_unit_test(a_stream_on_error_passes),
        cmocka_unit_test(a_fatal_error_is_recovered_from),
        cmocka_unit_test(an_unplugged_device_returns),
        cmocka_unit_test(the_sequence_may_wrap),
        cmocka_unit_test(another_signal_restarts_it),
        cmocka_unit_test(another_thread_stops_it),
        cmocka_unit_test(cycles_leak_nothing),
    };

    const struct CMUnitTest many[] = {cmocka_unit_test(cycles_leak_nothing)};

    if (argc != 2 && argc != 3)
        return 2;
    snprintf(node, sizeof node, "v4l2:%.40s", argv[1]);
    if (argc == 3) {
        cycles = atoi(argv[2]);
        return cmocka_run_group_tests(many, NULL, NULL);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
