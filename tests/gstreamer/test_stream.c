/* test_stream.c: times, events, states and failures of the element in a stream. */
#include <stdint.h>
#include "unit_test.h"
#include <math.h>
#include <string.h>
#include <gst/controller/gstdirectcontrolbinding.h>
#include <gst/controller/gstinterpolationcontrolsource.h>
#include "frames.h"
#include "plugin.h"
#include "settings.h"

#define SIZE "width=64,height=48,framerate=25/1"
#define NV12 "video/x-raw,format=NV12," SIZE
#if G_BYTE_ORDER == G_LITTLE_ENDIAN
#define P010 "video/x-raw,format=P010_10LE,colorimetry=bt601," SIZE
#else
#define P010 NV12
#endif
#define RGB   "video/x-raw,format=RGB,width=96,height=32,framerate=25/1"
#define DEPTH "video/x-raw,format=GRAY8," SIZE

enum { FRAME = 40 }; /* ms */

static GstFlowReturn push(GstHarness *harness, GstBuffer *buffer)
{
    return gst_harness_push(harness, buffer);
}

static GstFlowReturn push_depth(struct bench *bench, int value, int ms)
{
    return push(bench->depth, frame_flat(DEPTH, value, (GstClockTime)ms * GST_MSECOND));
}

static void end(GstHarness *harness)
{
    gst_harness_push_event(harness, gst_event_new_eos());
}

/* Whether the frame of this time comes out sharp: its map is all in focus. */
static bool comes_out_sharp(struct bench *bench, int ms)
{
    GstBuffer *const frame = frame_make(NV12, 3, (GstClockTime)ms * GST_MSECOND);
    GstBuffer *out;
    bool sharp;

    assert_int_equal(push(bench->video, gst_buffer_ref(frame)), GST_FLOW_OK);
    out = gst_harness_pull(bench->video);
    assert_non_null(out);
    assert_int_equal(GST_BUFFER_PTS(out), GST_BUFFER_PTS(frame));
    sharp = frame_same(NV12, frame, out);
    gst_buffer_unref(frame);
    gst_buffer_unref(out);
    return sharp;
}

/* Maps of 10 a second, frames of 25: the nearest in time counts, the earlier of two. A pad holds
 * one map, so the next is pushed when a frame has taken the last. */
TEST(pairing)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    assert_int_equal(push_depth(&bench, 255, 0), GST_FLOW_OK);
    assert_int_equal(push(bench.video, frame_make(NV12, 3, 0)), GST_FLOW_OK);
    assert_int_equal(push_depth(&bench, 0, 100), GST_FLOW_OK);
    gst_buffer_unref(gst_harness_pull(bench.video));
    assert_true(comes_out_sharp(&bench, 40));
    assert_true(comes_out_sharp(&bench, 50)); /* as near to both */
    assert_int_equal(push(bench.video, frame_make(NV12, 3, 51 * GST_MSECOND)), GST_FLOW_OK);
    assert_int_equal(push_depth(&bench, 255, 200), GST_FLOW_OK);
    gst_buffer_unref(gst_harness_pull(bench.video));
    assert_false(comes_out_sharp(&bench, 60));
    assert_false(comes_out_sharp(&bench, 150));
    end(bench.depth);
    assert_true(comes_out_sharp(&bench, 151));
    assert_true(comes_out_sharp(&bench, 1000)); /* the last map holds */
    bench_close(&bench);
}

TEST(new_caps)
{
    struct refocus_settings settings = frame_settings(1, 5);
    const char *const caps[] = {NV12, P010, RGB, P010, NV12};
    GstBuffer *depth = frame_make(DEPTH, 4, 0);
    struct refocus_disparity disparity;
    struct bench bench;
    GstMapInfo map;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 5.0, NULL);
    assert_int_equal(push(bench.depth, gst_buffer_ref(depth)), GST_FLOW_OK);
    end(bench.depth);
    gst_buffer_map(depth, &map, GST_MAP_READ);
    disparity = refocus_disparity8(map.data, 64, 48, 64);
    for (unsigned i = 0; i < G_N_ELEMENTS(caps); i++) {
        GstBuffer *const frame = frame_make(caps[i], i, i * FRAME * GST_MSECOND);
        GstBuffer *out, *expected;
        GstCaps *given, *wanted = gst_caps_from_string(caps[i]);

        gst_harness_set_src_caps_str(bench.video, caps[i]);
        assert_int_equal(push(bench.video, gst_buffer_ref(frame)), GST_FLOW_OK);
        out = gst_harness_pull(bench.video);
        given = gst_pad_get_current_caps(bench.video->sinkpad);
        assert_true(gst_caps_is_subset(given, wanted));
        expected = frame_expect(caps[i], frame, &disparity, &settings);
        assert_true(frame_same(caps[i], out, expected));
        gst_caps_unref(given);
        gst_caps_unref(wanted);
        gst_buffer_unref(frame);
        gst_buffer_unref(out);
        gst_buffer_unref(expected);
    }
    gst_buffer_unmap(depth, &map);
    gst_buffer_unref(depth);
    bench_close(&bench);
}

/* The error that one frame ends in, with the settings of `properties`. */
static void check_error(const char *properties, bool depth, int map, const char *words)
{
    struct bench bench;
    char *error;

    bench_open(&bench, NV12, depth ? DEPTH : NULL);
    gst_util_set_object_arg(G_OBJECT(bench.element), "threads", "1");
    if (properties) {
        char **const pairs = g_strsplit(properties, " ", 0);

        for (int i = 0; pairs[i]; i += 2)
            gst_util_set_object_arg(G_OBJECT(bench.element), pairs[i], pairs[i + 1]);
        g_strfreev(pairs);
    }
    if (map >= 0)
        push_depth(&bench, map, 0);
    if (depth)
        end(bench.depth);
    push(bench.video, frame_make(NV12, 0, 0));
    error = bench_error(&bench);
    if (!error || !strstr(error, words))
        fail_msg("with %s: '%s', not '%s'", properties, error, words);
    g_free(error);
    bench_close(&bench);
}

TEST(errors)
{
    check_error(NULL, false, -1, "link the pad depth, or give depth-location");
    check_error(NULL, true, -1, "ended without a depth map");
    check_error("aperture polygon:2", true, 9, "aperture 'polygon:2' is not known");
    check_error("aperture star:x", true, 9, "give disc, polygon:BLADES");
    check_error("f-number 2", true, 9, "give near and far");
    check_error("focus-distance 2", true, 9, "give near and far");
    check_error("depth-unit mm near 1", true, 9, "give near and far");
    check_error("depth-unit furlongs", true, 9, "depth-unit 'furlongs' is not known");
    check_error("method raytrace", true, 9, "not");
}

TEST(shapes)
{
    static const char *const good[] = {"disc",  "polygon:3", "polygon:16:-15.5",
                                       "heart", "star",      "star:7"};
    static const char *const bad[] = {"",
                                      "polygon",
                                      "polygon:",
                                      "polygon:2",
                                      "polygon:17",
                                      "polygon:5.5",
                                      "polygon:6:",
                                      "polygon:6:nan",
                                      "polygon:6:4000",
                                      "polygon:6:1:2",
                                      "star:",
                                      "star:2",
                                      "stars",
                                      "heart:3",
                                      "polygon:inf",
                                      "polygon: 6"};
    struct refocus_aperture *aperture;
    struct refocus_aperture_params shape;

    for (size_t i = 0; i < G_N_ELEMENTS(good); i++) {
        assert_true(rf_gst_read_shape(good[i], &shape));
        assert_int_equal(refocus_aperture_create(&aperture, &shape), REFOCUS_OK);
        refocus_aperture_destroy(&aperture);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
        if (rf_gst_read_shape(bad[i], &shape))
            fail_msg("'%s' is taken for a shape", bad[i]);
}

/* Frames before the depth, depth before the frames, and either end first. */
TEST(ends)
{
    struct bench bench;
    GstBuffer *out;

    for (int order = 0; order < 3; order++) {
        bench_open(&bench, NV12, DEPTH);
        if (order == 0) { /* frames first */
            assert_int_equal(push(bench.video, frame_make(NV12, 0, 0)), GST_FLOW_OK);
            end(bench.video);
            assert_int_equal(push_depth(&bench, 9, 0), GST_FLOW_OK);
            end(bench.depth);
        } else {
            assert_int_equal(push_depth(&bench, 9, 0), GST_FLOW_OK);
            if (order == 1)
                end(bench.depth);
            assert_int_equal(push(bench.video, frame_make(NV12, 0, 0)), GST_FLOW_OK);
            end(bench.video);
            if (order == 2)
                end(bench.depth);
        }
        out = gst_harness_pull(bench.video);
        assert_non_null(out);
        gst_buffer_unref(out);
        for (int i = 0; i < 8; i++) { /* stream-start, caps, segment, perhaps tags, eos */
            GstEvent *const event = gst_harness_pull_event(bench.video);
            const GstEventType type = GST_EVENT_TYPE(event);

            gst_event_unref(event);
            if (type == GST_EVENT_EOS)
                break;
            assert_int_not_equal(i, 7);
        }
        bench_close(&bench);
    }
}

static void flush(GstHarness *harness)
{
    GstSegment segment;

    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(harness, gst_event_new_flush_start());
    gst_harness_push_event(harness, gst_event_new_flush_stop(TRUE));
    gst_harness_push_event(harness, gst_event_new_segment(&segment));
}

/* After a seek back the map of the end must not serve the beginning. */
TEST(seek)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    assert_int_equal(push_depth(&bench, 255, 5000), GST_FLOW_OK);
    end(bench.depth);
    assert_true(comes_out_sharp(&bench, 5000));
    flush(bench.depth);
    flush(bench.video);
    assert_int_equal(push_depth(&bench, 0, 20000), GST_FLOW_OK); /* farther than the one before */
    end(bench.depth);
    assert_false(comes_out_sharp(&bench, 0));
    bench_close(&bench);
}

TEST(states)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    for (int i = 0; i < 5; i++) {
        GstSegment segment;

        assert_int_equal(push_depth(&bench, i % 2 ? 0 : 255, 0), GST_FLOW_OK);
        end(bench.depth);
        assert_int_equal(comes_out_sharp(&bench, 0), i % 2 == 0);
        assert_int_equal(gst_element_set_state(bench.element, GST_STATE_NULL),
                         GST_STATE_CHANGE_SUCCESS);
        assert_int_equal(gst_element_set_state(bench.element, GST_STATE_PLAYING),
                         GST_STATE_CHANGE_SUCCESS);
        gst_segment_init(&segment, GST_FORMAT_TIME);
        gst_harness_push_event(bench.depth, gst_event_new_stream_start("depth"));
        gst_harness_set_src_caps_str(bench.depth, DEPTH);
        gst_harness_push_event(bench.depth, gst_event_new_segment(&segment));
        gst_harness_push_event(bench.video, gst_event_new_stream_start("video"));
        gst_harness_set_src_caps_str(bench.video, NV12);
        gst_harness_push_event(bench.video, gst_event_new_segment(&segment));
    }
    bench_close(&bench);
}

/* A focus pull from 0 to 1 within a second, by the times of the frames. */
TEST(controller)
{
    GstControlSource *const source = gst_interpolation_control_source_new();
    GstBuffer *const depth = frame_make(DEPTH, 4, 0);
    struct refocus_disparity disparity;
    struct bench bench;
    GstMapInfo map;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(source, "mode", GST_INTERPOLATION_MODE_LINEAR, NULL);
    gst_timed_value_control_source_set(GST_TIMED_VALUE_CONTROL_SOURCE(source), 0, 0);
    gst_timed_value_control_source_set(GST_TIMED_VALUE_CONTROL_SOURCE(source), GST_SECOND, 1);
    gst_object_add_control_binding(
        GST_OBJECT(bench.element),
        gst_direct_control_binding_new(GST_OBJECT(bench.element), "focus", source));
    gst_object_unref(source);
    g_object_set(bench.element, "blur", 8.0, NULL);
    assert_int_equal(push(bench.depth, gst_buffer_ref(depth)), GST_FLOW_OK);
    end(bench.depth);
    gst_buffer_map(depth, &map, GST_MAP_READ);
    disparity = refocus_disparity8(map.data, 64, 48, 64);
    for (int i = 0; i <= 4; i++) {
        struct refocus_settings settings = frame_settings(i / 4.0, 8);
        GstBuffer *const frame = frame_make(NV12, 1, (GstClockTime)i * 250 * GST_MSECOND);
        GstBuffer *out, *expected;

        assert_int_equal(push(bench.video, gst_buffer_ref(frame)), GST_FLOW_OK);
        out = gst_harness_pull(bench.video);
        expected = frame_expect(NV12, frame, &disparity, &settings);
        assert_true(frame_same(NV12, out, expected));
        gst_buffer_unref(frame);
        gst_buffer_unref(out);
        gst_buffer_unref(expected);
    }
    gst_buffer_unmap(depth, &map);
    gst_buffer_unref(depth);
    bench_close(&bench);
}

/* Whether the frame that comes out is in focus at a disparity in codes of its map, which is all of
 * one value. */
static bool is_focused(struct bench *bench, GstBuffer *frame, int value, double at)
{
    const uint8_t sample = (uint8_t)value;
    const struct refocus_disparity disparity = refocus_disparity8(&sample, 1, 1, 1);
    struct refocus_settings settings = frame_settings(at / 255, 40);
    GstBuffer *const out = gst_harness_pull(bench->video);
    GstBuffer *const expected = frame_expect(NV12, frame, &disparity, &settings);
    const bool same = frame_same(NV12, out, expected);

    gst_buffer_unref(out);
    gst_buffer_unref(expected);
    return same;
}

/* The focus on a place settles within some frames, and is there at once where nothing was before.
 */
TEST(focus_of_a_place)
{
    static const struct {
        int ms, value;
        double x, far;
        bool at_once;
    } step[] = {
        {0, 100, 0.5, 0, true},     {40, 130, 0.5, 0, false},  {80, 100, 0.5, 0, false},
        {120, 130, 0.5, 0, false},  {160, 30, 0.5, 0, false},  {200, 200, 1, 0, true},
        {240, 100, 1, 0, false},    {1400, 200, 1, 0, true},   /* more than a second later */
        {1440, 100, -1, 0, true},                              /* by the property `focus` */
        {1480, 200, 0.2, 0, true},  {1520, 100, 0.2, 9, true}, /* another range */
        {1560, 200, 0.2, 9, false},
    };
    enum { STEPS = sizeof step / sizeof *step };
    const double part = exp(-0.5); /* 40 ms of 80 */
    struct bench bench;
    double at = 0;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 0.2, "focus-y", 1.0, "blur", 40.0, "near", 1.0, NULL);
    assert_int_equal(push_depth(&bench, step[0].value, step[0].ms), GST_FLOW_OK);
    for (int i = 0; i < STEPS; i++) {
        GstBuffer *const frame = frame_make(NV12, 3, (GstClockTime)step[i].ms * GST_MSECOND);

        g_object_set(bench.element, "focus-x", step[i].x, "far", step[i].far, NULL);
        assert_int_equal(push(bench.video, gst_buffer_ref(frame)), GST_FLOW_OK);
        if (i + 1 < STEPS)
            assert_int_equal(push_depth(&bench, step[i + 1].value, step[i + 1].ms), GST_FLOW_OK);
        else
            end(bench.depth);
        at = step[i].value + (step[i].at_once ? 0 : (at - step[i].value) * part);
        if (!is_focused(&bench, frame, step[i].value, step[i].x < 0 ? 51 : at))
            fail_msg("step %d", i);
        gst_buffer_unref(frame);
    }
    bench_close(&bench);
}

TEST(lateness)
{
    struct bench bench;
    GstMessage *message;
    guint64 rendered, dropped;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    assert_int_equal(push_depth(&bench, 255, 0), GST_FLOW_OK);
    end(bench.depth);
    assert_true(comes_out_sharp(&bench, 0));
    /* The frame of 0 ms was late by 50: those up to 100 are. */
    gst_harness_push_upstream_event(
        bench.video, gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 2, 50 * GST_MSECOND, 0));
    for (int left_out = 1; left_out <= 2; left_out++)
        push(bench.video, frame_make(NV12, 0, (GstClockTime)(60 + 20 * left_out) * GST_MSECOND));
    assert_true(comes_out_sharp(&bench, 120)); /* the next that comes out */
    for (guint64 left_out = 1; left_out <= 2; left_out++) {
        message = gst_bus_pop_filtered(bench.bus, GST_MESSAGE_QOS);
        assert_non_null(message);
        gst_message_parse_qos_stats(message, NULL, &rendered, &dropped);
        assert_true(rendered == 1 && dropped == left_out);
        gst_message_unref(message);
    }
    g_object_set(bench.element, "qos", FALSE, NULL);
    gst_harness_push_upstream_event(
        bench.video,
        gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 2, 50 * GST_MSECOND, 120 * GST_MSECOND));
    assert_true(comes_out_sharp(&bench, 160));
    bench_close(&bench);
}

/* A live element says when its frames come, and a depth camera that is silent does not stop it. */
TEST(live)
{
    struct bench bench;
    GstBuffer *frame, *out;

    bench_open(&bench, NV12, DEPTH);
    gst_harness_set_live(bench.video, TRUE);
    gst_harness_set_live(bench.depth, TRUE);
    gst_harness_set_upstream_latency(bench.video, FRAME * GST_MSECOND);
    gst_harness_use_testclock(bench.video);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    assert_int_equal(push_depth(&bench, 255, 0), GST_FLOW_OK);
    assert_int_equal(push(bench.video, frame_make(NV12, 0, 0)), GST_FLOW_OK);
    out = gst_harness_pull(bench.video);
    assert_non_null(out);
    gst_buffer_unref(out);
    assert_int_equal(gst_harness_query_latency(bench.video), 2 * FRAME * GST_MSECOND);
    /* A map that is farther off than half a frame is not taken before the next one is there. */
    assert_int_equal(push_depth(&bench, 255, 60), GST_FLOW_OK);
    frame = frame_make(NV12, 3, 90 * GST_MSECOND);
    assert_int_equal(push(bench.video, gst_buffer_ref(frame)), GST_FLOW_OK);
    g_usleep(20000);
    assert_int_equal(push_depth(&bench, 0, 95), GST_FLOW_OK);
    out = gst_harness_pull(bench.video);
    assert_false(frame_same(NV12, frame, out));
    gst_buffer_unref(frame);
    gst_buffer_unref(out);
    frame = frame_make(NV12, 0, 1000 * GST_MSECOND);
    assert_int_equal(push(bench.video, frame), GST_FLOW_OK);
    assert_true(gst_harness_crank_single_clock_wait(bench.video));
    out = gst_harness_pull(bench.video);
    assert_non_null(out);
    gst_buffer_unref(out);
    bench_close(&bench);
}

static void count(GstElement *element, GstSegment *segment, guint64 pts, guint64 dts,
                  guint64 duration, GstStructure *info, int *times)
{
    (void)element, (void)segment, (void)dts, (void)info;
    *times += pts == 0 && duration == FRAME * GST_MSECOND;
}

/* Flags, offsets and metas of a buffer stay; who asks is told when it is taken. */
TEST(metas)
{
    int selected = 0;
    GstCaps *const reference = gst_caps_new_empty_simple("timestamp/x-test");
    struct bench bench;
    GstBuffer *frame, *out;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "emit-signals", TRUE, NULL);
    g_signal_connect(bench.element, "samples-selected", G_CALLBACK(count), &selected);
    push_depth(&bench, 9, 0);
    end(bench.depth);
    frame = frame_make(NV12, 0, 0);
    gst_buffer_add_reference_timestamp_meta(frame, reference, 7, 8);
    GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_MARKER);
    GST_BUFFER_OFFSET(frame) = 77;
    push(bench.video, frame);
    out = gst_harness_pull(bench.video);
    assert_non_null(gst_buffer_get_reference_timestamp_meta(out, reference));
    assert_true(GST_BUFFER_FLAG_IS_SET(out, GST_BUFFER_FLAG_MARKER));
    assert_int_equal(GST_BUFFER_OFFSET(out), 77);
    assert_int_equal(selected, 1);
    gst_buffer_unref(out);
    gst_caps_unref(reference);
    bench_close(&bench);
}

/* Gaps on either pad. */
TEST(gaps)
{
    struct bench bench;

    bench_open(&bench, NV12, DEPTH);
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, NULL);
    push_depth(&bench, 255, 0);
    push(bench.video, frame_make(NV12, 0, 0));
    gst_harness_push_event(bench.depth, gst_event_new_gap(40 * GST_MSECOND, 40 * GST_MSECOND));
    gst_harness_push_event(bench.video, gst_event_new_gap(40 * GST_MSECOND, 40 * GST_MSECOND));
    end(bench.depth);
    gst_buffer_unref(gst_harness_pull(bench.video));
    assert_true(comes_out_sharp(&bench, 80));
    bench_close(&bench);
}

int main(void)
{
    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return unit_test_run(NULL, NULL);
}
