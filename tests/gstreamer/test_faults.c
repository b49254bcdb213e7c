/* test_faults.c: faults of cameras, depth sensors and what is between, as the element meets them:
 * the stream goes on. */
#include <stdbool.h>
#include <stdint.h>
#include "unit_test.h"
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

TEST(short_frame)
{
    is_left_out(gst_buffer_new_allocate(NULL, LUMA, NULL));
}

TEST(empty_frame)
{
    is_left_out(gst_buffer_new());
}

TEST(rows_beyond_memory)
{
    is_left_out(laid_out(LUMA * 3 / 2, 96, LUMA));
}

TEST(chroma_beyond_memory)
{
    is_left_out(laid_out(LUMA * 3 / 2, 64, LUMA + 640));
}

TEST(rows_too_narrow)
{
    is_left_out(laid_out(LUMA * 3 / 2, 32, LUMA));
}

TEST(another_size_than_said)
{
    GstBuffer *const frame = gst_buffer_new_allocate(NULL, LUMA * 6, NULL);

    gst_buffer_add_video_meta(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_NV12, 128, 96);
    is_left_out(frame);
}

TEST(odd_strides)
{
    struct bench bench;

    begin(&bench);
    end_depth(&bench);
    gst_buffer_unref(through(&bench, laid_out(71 * 72 + 9, 71, 71 * 48 + 9)));
    goes_on(&bench, 80, true);
    finish(&bench);
}

TEST(long_frame)
{
    struct bench bench;
    GstBuffer *const frame = frame_make(NV12, 0, ms(40));

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
TEST(corrupt_frame)
{
    flag_stays(GST_BUFFER_FLAG_CORRUPTED);
}

TEST(dropped_frames)
{
    flag_stays(GST_BUFFER_FLAG_DISCONT);
}

/* Frames whose times run backwards, or are a hundred seconds off, come out in order of arrival. */
TEST(times_out_of_order)
{
    static const int times[] = {80, 40, 100000, 120, 0};
    struct bench bench;

    begin(&bench);
    end_depth(&bench);
    for (size_t i = 0; i < G_N_ELEMENTS(times); i++)
        goes_on(&bench, times[i], true);
    finish(&bench);
}

TEST(frames_without_times)
{
    struct bench bench;

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

TEST(unknown_rate)
{
    struct bench bench;

    begin(&bench);
    end_depth(&bench);
    gst_harness_set_src_caps_str(bench.video, UNTIMED);
    goes_on(&bench, 0, true);
    goes_on(&bench, 1000, true);
    finish(&bench);
}

/* The map before it serves on. */
TEST(damaged_map)
{
    struct bench bench;
    GstBuffer *const map = gst_buffer_new_allocate(NULL, 64, NULL);

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
TEST(map_without_readings)
{
    static const int samples[] = {0, 1, 255, 2}; /* no value, 257 mm, no value, 514 mm */
    struct bench bench;

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

TEST(damaged_first_map)
{
    struct bench bench;

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

TEST(maps_without_times)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, "threads", 1, NULL);
    for (int i = 0; i < 3; i++) {
        GstBuffer *const map = frame_flat(DEPTH, i % 2 ? BLURRED : SHARP, GST_CLOCK_TIME_NONE);

        assert_int_equal(gst_harness_push(bench.depth, map), GST_FLOW_OK);
        goes_on(&bench, 40 * i, i % 2 == 0);
    }
    finish(&bench);
}

TEST(maps_back_in_time)
{
    struct bench bench;

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

TEST(maps_of_another_size)
{
    struct bench bench;

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
TEST(depth_camera_gone)
{
    struct bench bench;

    begin(&bench);
    end_depth(&bench);
    for (int i = 0; i < 4; i++)
        goes_on(&bench, 1000 * i, true);
    finish(&bench);
}

/* A frame that waits for its map does not keep the element from being stopped. */
TEST(stopped_while_waiting)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    assert_int_equal(gst_harness_push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    assert_int_equal(gst_element_set_state(bench.element, GST_STATE_NULL),
                     GST_STATE_CHANGE_SUCCESS);
    finish(&bench);
}

int main(void)
{
    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return unit_test_run(NULL, NULL);
}
