/* test_faults.c: faults of cameras, depth sensors and what is between, as the element meets them:
 * the stream goes on. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "frames.h"
#include "plugin.h"

#define SIZE    "width=64,height=48,framerate=25/1"
#define NV12    "video/x-raw,format=NV12," SIZE
#define DEPTH   "video/x-raw,format=GRAY8," SIZE
#define MM      "video/x-raw,format=GRAY16_LE," SIZE
#define SMALL   "video/x-raw,format=GRAY8,width=16,height=12,framerate=25/1"
#define UNTIMED "video/x-raw,format=NV12,width=64,height=48,framerate=0/1"

enum { LUMA = 64 * 48, SHARP = 255, BLURRED = 0 /* maps: all in focus, nothing */ };

static GstClockTime ms(int time)
{
    return (GstClockTime)time * GST_MSECOND;
}

/* An element that has a map by which all is in focus, and no other yet. */
static void begin(struct bench *bench)
{
    bench_open(bench, NV12, DEPTH);
    g_object_set(bench->element, "focus", 1.0, "blur", 8.0, "threads", 1, NULL);
    assert_int_equal(gst_harness_push(bench->depth, frame_flat(DEPTH, SHARP, 0)), GST_FLOW_OK);
}

static void end_depth(struct bench *bench)
{
    gst_harness_push_event(bench->depth, gst_event_new_eos());
}

static void finish(struct bench *bench)
{
    assert_null(gst_bus_pop_filtered(bench->bus, GST_MESSAGE_ERROR));
    bench_close(bench);
}

/* The frame that a buffer comes out as. */
static GstBuffer *through(struct bench *bench, GstBuffer *frame)
{
    GstBuffer *out;

    assert_int_equal(gst_harness_push(bench->video, frame), GST_FLOW_OK);
    out = gst_harness_pull(bench->video);
    assert_non_null(out);
    return out;
}

/* A good frame comes out with its time, and sharp if its map says so. */
static void goes_on(struct bench *bench, int time, bool sharp)
{
    GstBuffer *const frame = frame_make(NV12, 3, ms(time));
    GstBuffer *const out = through(bench, gst_buffer_ref(frame));

    assert_int_equal(GST_BUFFER_PTS(out), ms(time));
    assert_int_equal(frame_same(NV12, frame, out), sharp);
    gst_buffer_unref(frame);
    gst_buffer_unref(out);
}

/* The buffer does not come out, which is told of once, and the next one does. */
static void is_left_out(GstBuffer *frame)
{
    struct bench bench;
    GstMessage *message;

    begin(&bench);
    end_depth(&bench);
    GST_BUFFER_PTS(frame) = ms(40);
    assert_int_equal(gst_harness_push(bench.video, frame), GST_FLOW_OK);
    goes_on(&bench, 80, true);
    message = gst_bus_pop_filtered(bench.bus, GST_MESSAGE_WARNING);
    assert_non_null(message);
    gst_message_unref(message);
    message = gst_bus_pop_filtered(bench.bus, GST_MESSAGE_WARNING | GST_MESSAGE_QOS);
    assert_non_null(message);
    assert_int_equal(GST_MESSAGE_TYPE(message), GST_MESSAGE_QOS);
    gst_message_unref(message);
    assert_null(gst_bus_pop_filtered(bench.bus, GST_MESSAGE_WARNING));
    finish(&bench);
}

/* A buffer of NV12 whose rows its metadata lays out. */
static GstBuffer *laid_out(gsize bytes, int stride, gsize chroma)
{
    GstBuffer *const frame = gst_buffer_new_allocate(NULL, bytes, NULL);
    gsize offset[GST_VIDEO_MAX_PLANES] = {0, chroma};
    gint strides[GST_VIDEO_MAX_PLANES] = {stride, stride};

    gst_buffer_memset(frame, 0, 90, bytes);
    gst_buffer_add_video_meta_full(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_NV12, 64, 48,
                                   2, offset, strides);
    return frame;
}

static void short_frame(void **state)
{
    (void)state;
    is_left_out(gst_buffer_new_allocate(NULL, LUMA, NULL));
}

static void empty_frame(void **state)
{
    (void)state;
    is_left_out(gst_buffer_new());
}

static void rows_beyond_memory(void **state)
{
    (void)state;
    is_left_out(laid_out(LUMA * 3 / 2, 96, LUMA));
}

static void chroma_beyond_memory(void **state)
{
    (void)state;
    is_left_out(laid_out(LUMA * 3 / 2, 64, LUMA + 640));
}

static void rows_too_narrow(void **state)
{
    (void)state;
    is_left_out(laid_out(LUMA * 3 / 2, 32, LUMA));
}

static void another_size_than_said(void **state)
{
    GstBuffer *const frame = gst_buffer_new_allocate(NULL, LUMA * 6, NULL);

    (void)state;
    gst_buffer_add_video_meta(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_NV12, 128, 96);
    is_left_out(frame);
}

static void odd_strides(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    end_depth(&bench);
    gst_buffer_unref(through(&bench, laid_out(71 * 72 + 9, 71, 71 * 48 + 9)));
    goes_on(&bench, 80, true);
    finish(&bench);
}

static void long_frame(void **state)
{
    struct bench bench;
    GstBuffer *const frame = frame_make(NV12, 0, ms(40));

    (void)state;
    begin(&bench);
    end_depth(&bench);
    gst_buffer_append_memory(frame, gst_allocator_alloc(NULL, 100, NULL));
    gst_buffer_unref(through(&bench, frame));
    goes_on(&bench, 80, true);
    finish(&bench);
}

/* A flag of a frame stays with it; whoever shows it decides. */
static void flag_stays(GstBufferFlags flag)
{
    struct bench bench;
    GstBuffer *frame = frame_make(NV12, 0, ms(400));

    begin(&bench);
    end_depth(&bench);
    goes_on(&bench, 0, true);
    GST_BUFFER_FLAG_SET(frame, flag);
    frame = through(&bench, frame);
    assert_true(GST_BUFFER_FLAG_IS_SET(frame, flag));
    gst_buffer_unref(frame);
    goes_on(&bench, 440, true);
    finish(&bench);
}

/* Sources flag what a driver calls damaged. */
static void corrupt_frame(void **state)
{
    (void)state;
    flag_stays(GST_BUFFER_FLAG_CORRUPTED);
}

static void dropped_frames(void **state)
{
    (void)state;
    flag_stays(GST_BUFFER_FLAG_DISCONT);
}

/* Frames whose times run backwards, or are a hundred seconds off, come out in order of arrival. */
static void times_out_of_order(void **state)
{
    static const int times[] = {80, 40, 100000, 120, 0};
    struct bench bench;

    (void)state;
    begin(&bench);
    end_depth(&bench);
    for (size_t i = 0; i < G_N_ELEMENTS(times); i++)
        goes_on(&bench, times[i], true);
    finish(&bench);
}

static void frames_without_times(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    end_depth(&bench);
    for (int i = 0; i < 3; i++) {
        GstBuffer *frame = frame_make(NV12, 0, GST_CLOCK_TIME_NONE);

        GST_BUFFER_DURATION(frame) = GST_CLOCK_TIME_NONE;
        frame = through(&bench, frame);
        assert_false(GST_BUFFER_PTS_IS_VALID(frame));
        gst_buffer_unref(frame);
    }
    goes_on(&bench, 80, true);
    finish(&bench);
}

static void unknown_rate(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    end_depth(&bench);
    gst_harness_set_src_caps_str(bench.video, UNTIMED);
    goes_on(&bench, 0, true);
    goes_on(&bench, 1000, true);
    finish(&bench);
}

/* The map before it serves on. */
static void damaged_map(void **state)
{
    struct bench bench;
    GstBuffer *const map = gst_buffer_new_allocate(NULL, 64, NULL);

    (void)state;
    begin(&bench);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    GST_BUFFER_PTS(map) = ms(40);
    assert_int_equal(gst_harness_push(bench.depth, gst_buffer_ref(map)), GST_FLOW_OK);
    end_depth(&bench);
    gst_buffer_unref(gst_harness_pull(bench.video));
    goes_on(&bench, 40, true);
    goes_on(&bench, 80, true);
    assert_int_equal(GST_MINI_OBJECT_REFCOUNT_VALUE(map), 1);
    gst_buffer_unref(map);
    finish(&bench);
}

/* A depth camera whose lens is covered: the map before it serves on, and the next one counts. */
static void map_without_readings(void **state)
{
    static const int samples[] = {0, 1, 255, 2}; /* no value, 257 mm, no value, 514 mm */
    struct bench bench;

    (void)state;
    bench_open(&bench, NV12, MM);
    g_object_set(bench.element, "depth-unit", "mm", "near", 0.257, "far", 0.514, "focus", 1.0,
                 "blur", 8.0, "threads", 1, "invalid", "max", NULL);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    for (int i = 0; i < 4; i++) {
        if (i == 3)
            assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, ms(80))),
                             GST_FLOW_OK);
        assert_int_equal(gst_harness_push(bench.depth, frame_flat(MM, samples[i], ms(40 * i))),
                         GST_FLOW_OK);
    }
    end_depth(&bench);
    for (int i = 0; i < 2; i++)
        gst_buffer_unref(gst_harness_pull(bench.video));
    goes_on(&bench, 110, false);
    for (int i = 0; i < 2; i++)
        gst_message_unref(gst_bus_pop_filtered(bench.bus, GST_MESSAGE_WARNING));
    assert_null(gst_bus_pop_filtered(bench.bus, GST_MESSAGE_WARNING));
    finish(&bench);
}

static void damaged_first_map(void **state)
{
    struct bench bench;

    (void)state;
    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, "threads", 1, NULL);
    assert_int_equal(gst_harness_push(bench.depth, gst_buffer_new_allocate(NULL, 1, NULL)),
                     GST_FLOW_OK);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    assert_int_equal(gst_harness_push(bench.depth, frame_flat(DEPTH, SHARP, 0)), GST_FLOW_OK);
    end_depth(&bench);
    gst_buffer_unref(gst_harness_pull(bench.video));
    goes_on(&bench, 40, true);
    finish(&bench);
}

static void maps_without_times(void **state)
{
    struct bench bench;

    (void)state;
    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, "threads", 1, NULL);
    for (int i = 0; i < 3; i++) {
        GstBuffer *const map = frame_flat(DEPTH, i % 2 ? BLURRED : SHARP, GST_CLOCK_TIME_NONE);

        assert_int_equal(gst_harness_push(bench.depth, map), GST_FLOW_OK);
        goes_on(&bench, 40 * i, i % 2 == 0);
    }
    finish(&bench);
}

static void maps_back_in_time(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    assert_int_equal(gst_harness_push(bench.depth, frame_flat(DEPTH, BLURRED, ms(160))),
                     GST_FLOW_OK);
    gst_buffer_unref(gst_harness_pull(bench.video));
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, ms(200))), GST_FLOW_OK);
    assert_int_equal(gst_harness_push(bench.depth, frame_flat(DEPTH, SHARP, ms(120))), GST_FLOW_OK);
    end_depth(&bench);
    gst_buffer_unref(gst_harness_pull(bench.video));
    goes_on(&bench, 240, true);
    finish(&bench);
}

static void maps_of_another_size(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    gst_harness_set_src_caps_str(bench.depth, SMALL);
    assert_int_equal(gst_harness_push(bench.depth, frame_flat(SMALL, BLURRED, ms(40))),
                     GST_FLOW_OK);
    end_depth(&bench);
    gst_buffer_unref(gst_harness_pull(bench.video));
    goes_on(&bench, 40, false);
    finish(&bench);
}

/* The last map holds. */
static void depth_camera_gone(void **state)
{
    struct bench bench;

    (void)state;
    begin(&bench);
    end_depth(&bench);
    for (int i = 0; i < 4; i++)
        goes_on(&bench, 1000 * i, true);
    finish(&bench);
}

/* A frame that waits for its map does not keep the element from being stopped. */
static void stopped_while_waiting(void **state)
{
    struct bench bench;

    (void)state;
    bench_open(&bench, NV12, DEPTH);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    assert_int_equal(gst_element_set_state(bench.element, GST_STATE_NULL),
                     GST_STATE_CHANGE_SUCCESS);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_frame),           cmocka_unit_test(empty_frame),
        cmocka_unit_test(rows_beyond_memory),    cmocka_unit_test(chroma_beyond_memory),
        cmocka_unit_test(rows_too_narrow),       cmocka_unit_test(another_size_than_said),
        cmocka_unit_test(odd_strides),           cmocka_unit_test(long_frame),
        cmocka_unit_test(corrupt_frame),         cmocka_unit_test(dropped_frames),
        cmocka_unit_test(times_out_of_order),    cmocka_unit_test(frames_without_times),
        cmocka_unit_test(unknown_rate),          cmocka_unit_test(damaged_map),
        cmocka_unit_test(damaged_first_map),     cmocka_unit_test(map_without_readings),
        cmocka_unit_test(maps_without_times),    cmocka_unit_test(maps_back_in_time),
        cmocka_unit_test(maps_of_another_size),  cmocka_unit_test(depth_camera_gone),
        cmocka_unit_test(stopped_while_waiting),
    };

    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
