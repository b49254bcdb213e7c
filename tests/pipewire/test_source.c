/* test_source.c: what the source `pipewire:` makes of frames as other programs give them, in the
 * session of session.py. */
#include "../platform/capture/check.h"
#include "../clock.h"

#include <spa/buffer/meta.h>
#include <time.h>
#include <refocus/platform/convert.h>
#include <spa/param/video/raw.h>
#include "camera.h"

enum { WIDTH = 64, HEIGHT = 48, ROOM = 4096 };

static struct camera camera;

/* Mappings of this process of what has such a name. */
static int count_maps(const char *name)
{
    FILE *const file = fopen("/proc/self/maps", "r");
    char line[512];
    int n = 0;

    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        n += strstr(line, name) != NULL;
    fclose(file);
    return n;
}

static int64_t now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * (int64_t)1000000000 + now.tv_nsec;
}

static int open_camera(void **state)
{
    const uint32_t *const format = state ? *state : NULL;

    return camera_open(&camera, "scripted", format ? *format : SPA_VIDEO_FORMAT_NV12, WIDTH, HEIGHT,
                       ROOM, false)
               ? 0
               : 1;
}

static int open_device(void **state)
{
    (void)state;
    return camera_open(&camera, "scripted", SPA_VIDEO_FORMAT_NV12, WIDTH, HEIGHT, ROOM, true) ? 0
                                                                                              : 1;
}

static int close_camera(void **state)
{
    (void)state;
    camera_close(&camera);
    return 0;
}

/* It takes a moment until others see the node. */
static struct refocus_source *start_as(uint32_t format)
{
    struct refocus_source *source = NULL;
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_reason reason;
    int status = REFOCUS_ERR_GONE;

    for (int i = 0; i < 200 && status == REFOCUS_ERR_GONE; i++) {
        refocus_source_close(&source);
        assert_status(refocus_source_open(&source, "pipewire:scripted", &reason), REFOCUS_OK);
        status = refocus_source_start(source, NULL, &mode, &reason);
        if (status == REFOCUS_ERR_GONE)
            sleep_ms(20);
    }
    if (status != REFOCUS_OK)
        fail_msg("it does not start: %s", reason.text);
    assert_int_equal(mode.format, format);
    assert_int_equal(mode.width, WIDTH);
    assert_int_equal(mode.height, HEIGHT);
    return source;
}

static struct refocus_source *start(void)
{
    return start_as(REFOCUS_FRAME_NV12);
}

/* Show a frame, and once more where it went to somebody else, who has just left. */
static const struct refocus_frame *show(struct refocus_source *source, uint8_t value)
{
    const struct refocus_frame *frame = NULL;
    struct refocus_reason reason;
    int status = REFOCUS_ERR_TIMEOUT;

    for (int i = 0; i < 10 && status == REFOCUS_ERR_TIMEOUT; i++) {
        for (int j = 0; j < 100 && !camera_show(&camera, value); j++)
            sleep_ms(10);
        status = refocus_source_wait(source, 1000, &frame, &reason);
    }
    if (status != REFOCUS_OK)
        fail_msg("no frame: %d %s", status, reason.text);
    return frame;
}

static void check_bytes(const struct refocus_frame *frame, int width, int height, uint8_t value)
{
    assert_int_equal(frame->width, width);
    assert_int_equal(frame->height, height);
    for (int p = 0; p < 2; p++)
        for (int y = 0; y < (p ? height / 2 : height); y++)
            for (int x = 0; x < width; x++)
                assert_int_equal(frame->plane[p][y * frame->stride[p] + x], value + p);
}

static const struct refocus_frame *corrupt(struct refocus_source *source)
{
    const struct refocus_frame *frame = show(source, 7);

    assert_true(frame->flags & REFOCUS_FRAME_CORRUPT);
    return frame;
}

/* Reads all that the frame says is there: a sanitizer or the kernel would tell. */
static void read_all(const struct refocus_frame *frame)
{
    volatile uint8_t sum = 0;

    for (int p = 0; p < 2; p++)
        for (int y = 0; y < (p ? frame->height / 2 : frame->height); y++)
            for (int x = 0; x < frame->width; x++)
                sum = (uint8_t)(sum + frame->plane[p][y * frame->stride[p] + x]);
}

static void strides_and_offsets_are_followed(void **state)
{
    struct refocus_source *source = start();
    const struct refocus_frame *frame;
    uint8_t value = 10;

    (void)state;
    for (int32_t stride = 0; stride <= WIDTH + 64; stride += WIDTH + 16)
        for (camera.offset = 0; camera.offset < 300; camera.offset += 128) {
            camera.stride = stride;
            frame = show(source, value);
            assert_int_equal(frame->flags & REFOCUS_FRAME_CORRUPT, 0);
            assert_int_equal(frame->stride[0], stride ? stride : WIDTH);
            check_bytes(frame, WIDTH, HEIGHT, value++);
            assert_int_equal(frame->matrix, REFOCUS_MATRIX_BT709);
            assert_true(frame->flags & REFOCUS_FRAME_FULL_RANGE);
            refocus_source_release(source, frame);
        }
    refocus_source_close(&source);
}

/* Memory of a device, a plane each, is mapped where it lies, and unmapped at the end. */
static void memory_of_devices_is_mapped(void **state)
{
    strides_and_offsets_are_followed(state);
    for (int i = 0; i < 6; i++) {
        struct refocus_source *source = start();
        const struct refocus_frame *frame = show(source, 50);

        check_bytes(frame, WIDTH, HEIGHT, 50);
        for (int p = 0; p < 2; p++)
            assert_true(frame->dmabuf[p] >= 0);
        assert_true(frame->dmabuf[0] != frame->dmabuf[1]);
        refocus_source_release(source, frame);
        camera.size = 1;
        frame = show(source, 50);
        assert_true(frame->flags & REFOCUS_FRAME_CORRUPT);
        read_all(frame);
        refocus_source_release(source, frame);
        camera.size = 0;
        refocus_source_close(&source);
        close_camera(NULL);
        assert_int_equal(count_maps("memfd:plane"), 0);
        assert_int_equal(open_device(NULL), 0);
    }
}

/* Memory of a device that is smaller than what is said of it: to read it would end the program. */
static void memory_that_ends_early_is_refused(void **state)
{
    struct refocus_source *source = NULL;
    const struct refocus_frame *frame = NULL;
    struct refocus_reason reason;
    int status = REFOCUS_ERR_GONE;

    (void)state;
    camera.missing = 4096;
    for (int i = 0; i < 200 && status == REFOCUS_ERR_GONE; i++) {
        refocus_source_close(&source);
        assert_status(refocus_source_open(&source, "pipewire:scripted", &reason), REFOCUS_OK);
        status = refocus_source_start(source, NULL, NULL, &reason);
        if (status == REFOCUS_OK)
            status = refocus_source_wait(source, 3000, &frame, &reason);
        if (status == REFOCUS_ERR_GONE)
            sleep_ms(20);
    }
    assert_int_equal(status, REFOCUS_ERR_IO);
    assert_non_null(strstr(reason.text, "cannot be mapped"));
    refocus_source_close(&source);
}

static void what_does_not_fit_is_corrupt(void **state)
{
    static const struct {
        uint32_t offset, size;
        int32_t stride;
        uint32_t chunk, header;
    } faults[] = {{.chunk = SPA_CHUNK_FLAG_CORRUPTED},
                  {.header = SPA_META_HEADER_FLAG_CORRUPTED},
                  {.size = 1},
                  {.size = WIDTH * HEIGHT * 3 / 2 - 1},
                  {.stride = WIDTH - 1},
                  {.stride = -WIDTH},
                  {.stride = INT32_MIN},
                  {.stride = INT32_MAX},
                  {.stride = WIDTH * 16, .size = UINT32_MAX},
                  {.offset = 13000, .size = UINT32_MAX},
                  {.offset = UINT32_MAX, .size = 9}};
    enum { FAULTS = sizeof faults / sizeof *faults };
    struct refocus_source *source = start();
    struct refocus_source_counters counters = refocus_source_counters_default();
    const struct refocus_frame *frame;

    (void)state;
    for (int i = 0; i < FAULTS; i++) {
        struct pw_thread_loop *loop = camera.loop;

        pw_thread_loop_lock(loop);
        camera.offset = faults[i].offset;
        camera.size = faults[i].size;
        camera.stride = faults[i].stride > WIDTH + 64 ? 0 : faults[i].stride;
        camera.chunk_flags = faults[i].chunk;
        camera.header_flags = faults[i].header;
        camera.said_stride = faults[i].stride;
        pw_thread_loop_unlock(loop);
        frame = show(source, 7);
        if (!(frame->flags & REFOCUS_FRAME_CORRUPT))
            fail_msg("fault %d is not seen", i);
        read_all(frame);
        refocus_source_release(source, frame);
    }
    camera.offset = camera.size = camera.chunk_flags = camera.header_flags = 0;
    camera.stride = camera.said_stride = 0;
    frame = show(source, 9);
    check_bytes(frame, WIDTH, HEIGHT, 9);
    refocus_source_release(source, frame);
    refocus_source_get_counters(source, &counters);
    assert_int_equal(counters.corrupt, FAULTS);
    assert_int_equal(counters.frames, FAULTS + 1);
    assert_int_equal(counters.released, FAULTS + 1);
    refocus_source_close(&source);
}

/* Depth of 16 bits, with gaps between rows and without. */
static void grey_of_16_bits(void **state)
{
    struct refocus_source *source = start_as(REFOCUS_FRAME_Y16);
    struct refocus_converter *converter;
    static uint16_t samples[WIDTH * HEIGHT];

    (void)state;
    assert_status(refocus_converter_create(&converter), REFOCUS_OK);
    for (int gap = 0; gap < 64; gap += 32) {
        const struct refocus_frame *frame;

        camera.stride = gap ? 2 * WIDTH + gap : 0;
        frame = show(source, (uint8_t)(3 + gap));
        assert_int_equal(frame->format, REFOCUS_FRAME_Y16);
        assert_int_equal(frame->flags & REFOCUS_FRAME_CORRUPT, 0);
        assert_int_equal(frame->stride[0], 2 * WIDTH + gap);
        assert_status(refocus_convert_samples(converter, frame, samples, NULL), REFOCUS_OK);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            assert_int_equal(samples[i], 257 * (3 + gap));
        refocus_source_release(source, frame);
    }
    camera.stride = 2 * WIDTH;
    camera.size = 2 * WIDTH * HEIGHT - 1;
    refocus_source_release(source, corrupt(source));
    refocus_converter_destroy(&converter);
    refocus_source_close(&source);
}

/* Frames of JPEG are as long as their chunk says, and no longer than the memory. */
static void jpeg_has_its_length(void **state)
{
    struct refocus_source *source = start_as(REFOCUS_FRAME_MJPEG);
    const struct refocus_frame *frame;

    (void)state;
    for (uint32_t size = 1; size < WIDTH * HEIGHT; size += 700) {
        camera.size = size;
        camera.offset = size % 300;
        frame = show(source, 200);
        assert_int_equal(frame->format, REFOCUS_FRAME_MJPEG);
        assert_int_equal(frame->flags & REFOCUS_FRAME_CORRUPT, 0);
        assert_int_equal(frame->bytes, size);
        for (uint32_t i = 0; i < size; i++)
            assert_int_equal(frame->plane[0][i], 200);
        refocus_source_release(source, frame);
    }
    camera.size = UINT32_MAX;
    frame = show(source, 7);
    assert_in_range(frame->bytes, WIDTH * HEIGHT, 2 * WIDTH * HEIGHT + ROOM + 64 * HEIGHT);
    for (size_t i = 0; i < frame->bytes; i++)
        assert_in_range(frame->plane[0][i], 0, 7);
    refocus_source_release(source, frame);
    camera.header_flags = SPA_META_HEADER_FLAG_CORRUPTED;
    refocus_source_release(source, corrupt(source));
    refocus_source_close(&source);
}

static void times_and_numbers_are_the_camera_s(void **state)
{
    struct refocus_source *source = start();
    struct refocus_source_counters counters = refocus_source_counters_default();
    const struct refocus_frame *frame;
    const int64_t begin = now_ns();

    (void)state;
    for (int i = 0; i < 5; i++) {
        camera.sequence = UINT32_MAX - 3 + (uint64_t)(i < 3 ? i : i + 2);
        camera.pts = begin + i * INT64_C(33000000);
        frame = show(source, 1);
        assert_true(frame->timestamp_ns == camera.pts);
        assert_int_equal(frame->sequence, (uint32_t)camera.sequence);
        assert_true(frame->flags & REFOCUS_FRAME_MONOTONIC);
        refocus_source_release(source, frame);
    }
    refocus_source_get_counters(source, &counters);
    assert_int_equal(counters.dropped, 2);
    camera.pts = -1; /* none: when it came */
    frame = show(source, 1);
    assert_true(frame->timestamp_ns >= begin && frame->timestamp_ns <= now_ns());
    refocus_source_release(source, frame);
    refocus_source_close(&source);
}

/* A camera whose clock is another one. */
static void other_clocks_are_not_said_to_be_ours(void **state)
{
    struct refocus_source *source = start();
    const struct refocus_frame *frame;

    (void)state;
    for (int i = 1; i < 4; i++) {
        camera.pts = i;
        frame = show(source, 1);
        assert_true(frame->timestamp_ns == i);
        assert_false(frame->flags & REFOCUS_FRAME_MONOTONIC);
        refocus_source_release(source, frame);
    }
    refocus_source_close(&source);
}

static void a_frame_that_is_out_outlives_a_change_of_size(void **state)
{
    struct refocus_source *source = start();
    const struct refocus_frame *held = show(source, 20), *frame;

    (void)state;
    camera_resize(&camera, 32, 24);
    for (int i = 0; i < 30; i++) { /* both sides agree, and would unmap it */
        check_bytes(held, WIDTH, HEIGHT, 20);
        sleep_ms(10);
    }
    refocus_source_release(source, held);
    frame = show(source, 30);
    assert_true(frame->flags & REFOCUS_FRAME_CHANGED);
    check_bytes(frame, 32, 24, 30);
    refocus_source_release(source, frame);
    frame = show(source, 31);
    assert_false(frame->flags & REFOCUS_FRAME_CHANGED);
    camera_resize(&camera, WIDTH, HEIGHT);
    sleep_ms(200);
    check_bytes(frame, 32, 24, 31);
    refocus_source_close(&source); /* with the frame out */
}

static void everything_is_given_back(void **state)
{
    int descriptors = 0, threads = 0;

    (void)state;
    for (int i = 0; i < 12; i++) {
        struct refocus_source *source = start();
        const struct refocus_frame *frame = show(source, 5);

        check_bytes(frame, WIDTH, HEIGHT, 5);
        if (i % 2) {
            /* Frames first: a node that ends while it is linked costs libpipewire an eventfd. */
            refocus_source_release(source, frame);
            assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_OK);
            check_bytes(show(source, 6), WIDTH, HEIGHT, 6);
        }
        refocus_source_close(&source);
        camera_close(&camera); /* PipeWire 0.3.65 gives it no buffer back that was with us */
        assert_int_equal(open_camera(NULL), 0);
        if (i == 3) {
            sleep_ms(300); /* until the camera is known to all */
            descriptors = count_entries("fd");
            threads = count_entries("task");
        }
    }
    sleep_ms(300);
    assert_in_range(count_entries("fd"), 0, descriptors);
    assert_in_range(count_entries("task"), 0, threads);
}

static void modes_are_listed(void **state)
{
    struct refocus_source *source = start();
    struct refocus_source_mode mode = refocus_source_mode_default();

    (void)state;
    assert_status(refocus_source_get_mode(source, 0, &mode), REFOCUS_OK);
    assert_int_equal(mode.format, REFOCUS_FRAME_NV12);
    assert_int_equal(mode.width, WIDTH);
    assert_int_equal(mode.height, HEIGHT);
    assert_true(mode.fps == 30);
    assert_status(refocus_source_get_mode(source, 1, &mode), REFOCUS_ERR_ARGUMENT);
    refocus_source_close(&source);
}

static void a_camera_that_ends_is_gone(void **state)
{
    struct refocus_source *source = start();
    const struct refocus_frame *frame = show(source, 40);
    int status;

    (void)state;
    camera_close(&camera);
    for (int i = 0; i < 20; i++) {
        check_bytes(frame, WIDTH, HEIGHT, 40);
        sleep_ms(10);
    }
    refocus_source_release(source, frame);
    status = refocus_source_wait(source, 2000, &frame, NULL);
    assert_int_equal(status, REFOCUS_ERR_GONE);
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_ERR_GONE);
    assert_int_equal(open_camera(NULL), 0);
    for (int i = 0; i < 200 && status == REFOCUS_ERR_GONE; i++) {
        sleep_ms(20);
        status = refocus_source_restart(source, NULL, NULL);
    }
    assert_int_equal(status, REFOCUS_OK);
    frame = show(source, 41);
    check_bytes(frame, WIDTH, HEIGHT, 41);
    refocus_source_close(&source);
}

int main(void)
{
    static uint32_t grey = SPA_VIDEO_FORMAT_GRAY16_LE, jpeg = SPA_VIDEO_FORMAT_ENCODED;
#define WITH_CAMERA(name) cmocka_unit_test_setup_teardown(name, open_camera, close_camera)
#define TEST_OF(name, format)                                                                      \
    cmocka_unit_test_prestate_setup_teardown(name, open_camera, close_camera, &format)
    const struct CMUnitTest tests[] = {
        WITH_CAMERA(strides_and_offsets_are_followed),
        cmocka_unit_test_setup_teardown(memory_of_devices_is_mapped, open_device, close_camera),
        cmocka_unit_test_setup_teardown(memory_that_ends_early_is_refused, open_device,
                                        close_camera),
        WITH_CAMERA(what_does_not_fit_is_corrupt),
        TEST_OF(grey_of_16_bits, grey),
        TEST_OF(jpeg_has_its_length, jpeg),
        WITH_CAMERA(times_and_numbers_are_the_camera_s),
        WITH_CAMERA(other_clocks_are_not_said_to_be_ours),
        WITH_CAMERA(a_frame_that_is_out_outlives_a_change_of_size),
        WITH_CAMERA(everything_is_given_back),
        WITH_CAMERA(modes_are_listed),
        WITH_CAMERA(a_camera_that_ends_is_gone),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
