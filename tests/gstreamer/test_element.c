/* test_element.c: the element's frames are the library's own, whatever the caps, times and events.
 */
#include <stdbool.h>
#include <stdint.h>
#include "unit_test.h"
#include <string.h>
#include "frames.h"
#include "plugin.h"

#define SIZE  "width=64,height=48,framerate=25/1"
#define NV12  "video/x-raw,format=NV12," SIZE
#define RGB   "video/x-raw,format=RGB," SIZE
#define DEPTH "video/x-raw,format=GRAY16_LE," SIZE

static struct refocus_disparity disparity_of(GstMapInfo *map, int bits, int width, int height)
{
    return bits == 16 ? refocus_disparity16((const uint16_t *)(void *)map->data, width, height,
                                            GST_ROUND_UP_4(width * 2))
                      : refocus_disparity8(map->data, width, height, GST_ROUND_UP_4(width));
}

/* One frame with one map through the element, against the library. */
static void check_frame(const char *caps, const char *depth_caps, int bits, int width, int height)
{
    struct refocus_settings settings = frame_settings(0.75, 6);
    struct refocus_disparity disparity;
    GstBuffer *frame, *depth, *out, *expected;
    struct bench bench;
    GstMapInfo map;

    bench_open(&bench, caps, depth_caps);
    g_object_set(bench.element, "focus", 0.75, "blur", 6.0, "threads", 2, NULL);
    frame = frame_make(caps, 1, 0);
    depth = frame_make(depth_caps, 2, 0);
    assert_int_equal(gst_harness_push(bench.depth, gst_buffer_ref(depth)), GST_FLOW_OK);
    gst_harness_push_event(bench.depth, gst_event_new_eos());
    assert_int_equal(gst_harness_push(bench.video, gst_buffer_ref(frame)), GST_FLOW_OK);
    out = gst_harness_pull(bench.video);
    assert_non_null(out);
    gst_buffer_map(depth, &map, GST_MAP_READ);
    disparity = disparity_of(&map, bits, width, height);
    expected = frame_expect(caps, frame, &disparity, &settings);
    gst_buffer_unmap(depth, &map);
    if (!frame_same(caps, out, expected))
        fail_msg("%s is not what the library renders", caps);
    assert_false(frame_same(caps, out, frame));
    assert_int_equal(GST_BUFFER_PTS(out), 0);
    assert_int_equal(GST_BUFFER_DURATION(out), 40 * GST_MSECOND);
    gst_buffer_unref(frame);
    gst_buffer_unref(depth);
    gst_buffer_unref(out);
    gst_buffer_unref(expected);
    bench_close(&bench);
}

TEST(formats)
{
    static const char *const names[] = {"NV12", "NV21", "I420", "YV12", "YUY2", "GRAY8",
                                        "RGB",  "BGR",  "RGBA", "BGRA", "RGBx", "BGRx"};
    char caps[128];

    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_snprintf(caps, sizeof caps, "video/x-raw,format=%s," SIZE, names[i]);
        check_frame(caps, DEPTH, 16, 64, 48);
    }
    check_frame("video/x-raw,format=NV12,width=63,height=47,framerate=25/1", DEPTH, 16, 64, 48);
}

/* Matrices and ranges; BT.2020 of 8 bits is nearest to BT.709. In numbers of GStreamer: the range
 * is 1 for 0 to 255 and 2 for 16 to 235. */
TEST(colours)
{
    static const char *const kinds[] = {"NV12,colorimetry=bt709", "NV12,colorimetry=bt2020",
                                        "NV12,colorimetry=1:4:0:0", "I420,colorimetry=1:3:0:0",
                                        "GRAY8,colorimetry=2:4:0:0"};
    char caps[128];

    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        g_snprintf(caps, sizeof caps, "video/x-raw,format=%s," SIZE, kinds[i]);
        check_frame(caps, DEPTH, 16, 64, 48);
    }
}

/* Ten bits by the curves of video, PQ and HLG. */
TEST(ten_bits)
{
    static const char *const colours[] = {"bt601", "bt2100-pq", "bt2100-hlg"};
    char caps[160];

    for (size_t i = 0; i < G_N_ELEMENTS(colours); i++) {
        g_snprintf(caps, sizeof caps, "video/x-raw,format=P010_10LE,colorimetry=%s," SIZE,
                   colours[i]);
        check_frame(caps, DEPTH, 16, 64, 48);
    }
    check_frame("video/x-raw,format=P010_10LE,colorimetry=bt601,width=63,height=47,framerate=25/1",
                DEPTH, 16, 64, 48);
}

TEST(depth_of_other_kinds)
{
    check_frame(NV12, "video/x-raw,format=GRAY8," SIZE, 8, 64, 48);
    check_frame(RGB, "video/x-raw,format=GRAY16_LE,width=31,height=23,framerate=5/1", 16, 31, 23);
    check_frame(NV12, "video/x-raw,format=GRAY8,width=21,height=90,framerate=0/1", 8, 21, 90);
}

/* A dark frame with lamps that are clipped, each by so many pixels to a side. */
static GstBuffer *lamps(int side, int ms)
{
    GstBuffer *const frame = frame_flat(NV12, 40, (GstClockTime)ms * GST_MSECOND);
    GstMapInfo map;

    gst_buffer_map(frame, &map, GST_MAP_WRITE);
    memset(map.data + (size_t)64 * 48, 128, (size_t)64 * 24);
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 64; x++)
            if (x % 16 >= 6 && x % 16 < 6 + side && y % 16 >= 6 && y % 16 < 8)
                map.data[64 * y + x] = 235;
    gst_buffer_unmap(frame, &map);
    return frame;
}

/* Whether lamps come out as the library renders them by themselves. */
static bool lamps_come_alone(struct bench *bench, int side, int ms)
{
    struct refocus_settings settings = frame_settings(1, 8);
    const uint8_t far = 0;
    const struct refocus_disparity disparity = refocus_disparity8(&far, 1, 1, 1);
    GstBuffer *const frame = lamps(side, ms);
    GstBuffer *expected, *out;
    bool same;

    settings.highlights.estimate = 0;
    settings.highlights.gain = 6;
    expected = frame_expect(NV12, frame, &disparity, &settings);
    assert_int_equal(gst_harness_push(bench->video, frame), GST_FLOW_OK);
    out = gst_harness_pull(bench->video);
    assert_non_null(out);
    same = frame_same(NV12, out, expected);
    gst_buffer_unref(out);
    gst_buffer_unref(expected);
    return same;
}

/* Light of highlights follows that of the last frame, unless that shows another moment. */
TEST(steady_light)
{
    struct bench bench;
    GstSegment segment;

    bench_open(&bench, NV12, "video/x-raw,format=GRAY8,width=1,height=1,framerate=25/1");
    g_object_set(bench.element, "focus", 1.0, "blur", 8.0, "highlights", 6.0, NULL);
    assert_int_equal(
        gst_harness_push(
            bench.depth,
            frame_flat("video/x-raw,format=GRAY8,width=1,height=1,framerate=25/1", 0, 0)),
        GST_FLOW_OK);
    gst_harness_push_event(bench.depth, gst_event_new_eos());
    assert_true(lamps_come_alone(&bench, 7, 0));
    assert_false(lamps_come_alone(&bench, 8, 40));
    assert_false(lamps_come_alone(&bench, 7, 80));
    assert_true(lamps_come_alone(&bench, 8, 1500));
    assert_true(lamps_come_alone(&bench, 7, 1540)); /* the first one is not kept */
    assert_false(lamps_come_alone(&bench, 8, 1580));
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(bench.video, gst_event_new_segment(&segment));
    assert_true(lamps_come_alone(&bench, 7, 1620));
    assert_true(lamps_come_alone(&bench, 8, 1660));
    assert_false(lamps_come_alone(&bench, 7, 1700));
    assert_true(lamps_come_alone(&bench, 8, 1400));
    bench_close(&bench);
}

int main(void)
{
    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return unit_test_run(NULL, NULL);
}
