/* test_settings.c: properties that change while frames come, one after the other or to what cannot
 * be: the stream goes on. */
#include <stdbool.h>
#include <stdint.h>
#include "unit_test.h"
#include <string.h>
#include "frames.h"
#include "plugin.h"

#define SIZE "width=64,height=48,framerate=25/1"
#define NV12 "video/x-raw,format=NV12," SIZE
#define MAPS "video/x-raw,format=GRAY16_LE," SIZE

/* An element whose maps are in this unit. */
static void begin(struct bench *bench, const char *unit, double near_m, double far_m)
{
    bench_open(bench, NV12, MAPS);
    g_object_set(bench->element, "depth-unit", unit, "near", near_m, "far", far_m, "focus", 1.0,
                 "blur", 8.0, "threads", 1, NULL);
}

/* A frame, the same each time, and a map of 1028. Without a time each frame takes the next map. */
static void push(struct bench *bench)
{
    assert_int_equal(gst_harness_push(bench->depth, frame_flat(MAPS, 4, GST_CLOCK_TIME_NONE)),
                     GST_FLOW_OK);
    gst_harness_push(bench->video, frame_make(NV12, 3, 0));
}

static GstBuffer *next(struct bench *bench)
{
    push(bench);
    return gst_harness_pull(bench->video);
}

/* Whether the next frame comes out as that one; with a warning on the bus, or with none. */
static void comes_as(struct bench *bench, GstBuffer *expected, bool warned)
{
    GstBuffer *const out = next(bench);
    GstMessage *message;

    assert_non_null(out);
    assert_true(frame_same(NV12, out, expected));
    gst_buffer_unref(out);
    message = gst_bus_pop_filtered(bench->bus, GST_MESSAGE_WARNING | GST_MESSAGE_ERROR);
    assert_int_equal(message ? GST_MESSAGE_TYPE(message) : 0, warned ? GST_MESSAGE_WARNING : 0);
    if (message)
        gst_message_unref(message);
}

/* Both are changed while frames come, and one is changed first. */
TEST(near_before_far)
{
    GstBuffer *const sharp = frame_make(NV12, 3, 0);
    GstBuffer *before;
    struct bench bench;

    begin(&bench, "mm", 0.5, 4);
    before = next(&bench);
    assert_non_null(before);
    assert_false(frame_same(NV12, before, sharp));
    g_object_set(bench.element, "near", 5.0, NULL);
    comes_as(&bench, before, true);
    comes_as(&bench, before, false);
    g_object_set(bench.element, "far", 9.0, NULL);
    comes_as(&bench, sharp, false); /* all is nearer than 5 m, which is in focus */
    gst_buffer_unref(sharp);
    gst_buffer_unref(before);
    bench_close(&bench);
}

/* A range that cannot be is not kept with maps that need none, either. */
TEST(lens_before_range)
{
    GstBuffer *before, *by_lens, *wider;
    struct bench bench;

    begin(&bench, "disparity", 0, 0);
    before = next(&bench);
    assert_non_null(before);
    g_object_set(bench.element, "f-number", 1.4, NULL);
    comes_as(&bench, before, true);
    g_object_set(bench.element, "near", 0.5, NULL);
    comes_as(&bench, before, false);
    g_object_set(bench.element, "far", 4.0, NULL);
    by_lens = next(&bench);
    assert_false(frame_same(NV12, by_lens, before));
    g_object_set(bench.element, "near", 5.0, NULL);
    comes_as(&bench, by_lens, true);
    g_object_set(bench.element, "far", 9.0, NULL);
    wider = next(&bench);
    assert_false(frame_same(NV12, wider, by_lens));
    gst_buffer_unref(before);
    gst_buffer_unref(by_lens);
    gst_buffer_unref(wider);
    bench_close(&bench);
}

/* The frame is that of the greatest blur, which is told once. */
TEST(more_blur_than_the_method_has)
{
    GstBuffer *most;
    struct bench bench;

    begin(&bench, "disparity", 0, 0);
    gst_util_set_object_arg(G_OBJECT(bench.element), "method", "search");
    g_object_set(bench.element, "blur", 127.0, NULL);
    most = next(&bench);
    for (int i = 0; i < 2; i++) {
        g_object_set(bench.element, "blur", 200.0, NULL);
        comes_as(&bench, most, true);
        comes_as(&bench, most, false);
        g_object_set(bench.element, "blur", 127.0, NULL);
        comes_as(&bench, most, false);
    }
    gst_buffer_unref(most);
    bench_close(&bench);
}

TEST(unknown_aperture)
{
    GstBuffer *before;
    struct bench bench;

    begin(&bench, "disparity", 0, 0);
    before = next(&bench);
    assert_non_null(before);
    for (int i = 0; i < 2; i++) {
        g_object_set(bench.element, "aperture", "polygon", NULL);
        comes_as(&bench, before, true);
        g_object_set(bench.element, "aperture", "disc", NULL);
        comes_as(&bench, before, false);
    }
    gst_buffer_unref(before);
    bench_close(&bench);
}

/* The picture by a map of 1028 mm but for so many samples. */
static GstBuffer *by_codes(struct bench *bench, int code, int count)
{
    GstBuffer *const map = frame_flat(MAPS, 4, GST_CLOCK_TIME_NONE);
    GstMapInfo info;

    gst_buffer_map(map, &info, GST_MAP_WRITE);
    for (int i = 0; i < count; i++)
        ((uint16_t *)(void *)info.data)[20 * 64 + i] = (uint16_t)code;
    gst_buffer_unmap(map, &info);
    assert_int_equal(gst_harness_push(bench->depth, map), GST_FLOW_OK);
    gst_harness_push(bench->video, frame_make(NV12, 3, 0));
    return gst_harness_pull(bench->video);
}

/* Whether 65535 is a distance does not change from map to map, and codes that are said to hold no
 * value do not. */
TEST(samples_without_a_value)
{
    static const struct {
        const char *unit, *invalid;
        int code, count;
        bool hole;
    } maps[] = {{"mm", NULL, 65535, 30, true}, /* 31 are a hundredth */
                {"mm", NULL, 65535, 32, true},          {"mm", NULL, 65535, 400, false},
                {"mm", "max", 65535, 400, true},        {"mm", "zero,2047", 2047, 400, true},
                {"disparity", NULL, 65535, 400, false}, {"disparity", "max", 65535, 400, true}};
    struct bench bench;

    for (size_t i = 0; i < G_N_ELEMENTS(maps); i++) {
        GstBuffer *plain, *out;

        begin(&bench, maps[i].unit, 0.5, 4);
        g_object_set(bench.element, "invalid", maps[i].invalid, NULL);
        plain = by_codes(&bench, 65535, 0);
        out = by_codes(&bench, maps[i].code, maps[i].count);
        assert_int_equal(frame_same(NV12, out, plain), maps[i].hole);
        gst_buffer_unref(plain);
        gst_buffer_unref(out);
        bench_close(&bench);
    }
}

/* Before the first frame there is nothing to go on with. */
TEST(wrong_from_the_beginning)
{
    static const char *const wrong[][3] = {
        {"aperture", "polygon", "aperture 'polygon' is not known"},
        {"invalid", "zero,x", "invalid 'zero,x' is not known; give zero, max or numbers"}};

    for (size_t i = 0; i < G_N_ELEMENTS(wrong); i++) {
        struct bench bench;
        char *words;

        begin(&bench, "disparity", 0, 0);
        g_object_set(bench.element, wrong[i][0], wrong[i][1], NULL);
        push(&bench);
        words = bench_error(&bench);
        assert_non_null(words);
        assert_non_null(strstr(words, wrong[i][2]));
        g_free(words);
        bench_close(&bench);
    }
}

int main(void)
{
    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return unit_test_run(NULL, NULL);
}
