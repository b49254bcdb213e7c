/* test_memory.c: each allocation of the operation's own fails once: the photo goes through as it
 * is, and a line says why. */
#include <stdint.h>
#include "unit_test.h"
#include <string.h>
#include "failing.h"
#include "graph.h"

/* A photo of floats with a map that has holes, focused at a place. */
static void run_once(const char *format, long fail_at)
{
    const guint16 clear[2] = {0, 0};
    GeglBuffer *const map = graph_map("Y'A u16", 0, 0, 32, 24);
    struct graph graph;

    gegl_buffer_set_color_from_pixel(map, GEGL_RECTANGLE(4, 4, 3, 3), clear,
                                     babl_format("Y'A u16"));
    graph_open(&graph, graph_picture(format, 0, 0, 32, 24, 4), map);
    gegl_node_set(graph.lens, "focus-x", 0.1, "focus-y", 0.1, NULL);
    failing.calls = 0;
    failing.fail_at = fail_at;
    assert_int_equal(graph_passes(&graph, format), fail_at > 0);
    failing.fail_at = 0;
    assert_int_equal(graph_messages.count, fail_at > 0);
    if (fail_at > 0)
        assert_non_null(strstr(graph_messages.last, "not enough memory"));
    graph_close(&graph);
}

static void memory(void **state)
{
    static const char *const formats[] = {"R'G'B'A u8", "R'G'B' u16", "RGBA float"};

    (void)state;
    for (size_t i = 0; i < G_N_ELEMENTS(formats); i++) {
        long calls;

        run_once(formats[i], 0);
        calls = failing.calls;
        assert_true(calls >= 5); /* samples, photo, disparities, confidence, those of the focus */
        for (long at = 1; at <= calls; at++)
            run_once(formats[i], at);
        assert_int_equal(failing.live, 0);
    }
}

static int run(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(memory)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void)
{
    return graph_run(run);
}
