/* test_memory.c: each allocation of the element's own fails once, and ends in an error in words. */
#include <stdbool.h>
#include <stdint.h>
#include "unit_test.h"
#include <string.h>
#include "failing.h"
#include "frames.h"
#include "plugin.h"

#define GREY  "video/x-raw,format=GRAY8,width=32,height=32,framerate=25/1"
#define DEPTH "video/x-raw,format=GRAY16_LE,width=32,height=32,framerate=25/1"

/* One frame with a map in millimetres that is kept steady; false: the frame did not come out. */
static bool run_once(long fail_at)
{
    struct bench bench;
    GstFlowReturn flow = GST_FLOW_OK;
    GstBuffer *out;
    char *error;

    bench_open(&bench, GREY, DEPTH);
    gst_util_set_object_arg(G_OBJECT(bench.element), "depth-unit", "mm");
    g_object_set(bench.element, "near", 5.0, "far", 60.0, "steady", 0.8, "threads", 1, NULL);
    failing.calls = 0;
    failing.fail_at = fail_at;
    gst_harness_push(bench.depth, frame_make(DEPTH, 1, 0));
    gst_harness_push_event(bench.depth, gst_event_new_eos());
    flow = gst_harness_push(bench.video, frame_make(GREY, 0, 0));
    gst_harness_push_event(bench.video, gst_event_new_eos());
    assert_true(flow == GST_FLOW_OK || flow == GST_FLOW_EOS || flow == GST_FLOW_ERROR);
    if (fail_at == 0) {
        assert_int_equal(flow, GST_FLOW_OK);
        out = gst_harness_pull(bench.video);
        assert_non_null(out);
        gst_buffer_unref(out);
        failing.fail_at = 0;
        bench_close(&bench);
        return true;
    }
    error = bench_error(&bench);
    failing.fail_at = 0;
    assert_non_null(error);
    assert_string_equal(error, refocus_strerror(REFOCUS_ERR_MEMORY));
    g_free(error);
    bench_close(&bench);
    return false;
}

TEST(memory)
{
    long calls;

    assert_true(run_once(0));
    calls = failing.calls;
    assert_true(calls >= 3); /* chroma of both frames, disparities */
    for (long i = 1; i <= calls; i++)
        assert_false(run_once(i));
    assert_int_equal(failing.live, 0);
}

int main(void)
{
    gst_init(NULL, NULL);
    if (!rf_gst_register(NULL))
        return 1;
    return unit_test_run(NULL, NULL);
}
