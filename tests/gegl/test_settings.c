/* test_settings.c: each property of the operation does what it says, at its ends too. */
#include <stdint.h>
#include "unit_test.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "graph.h"

/* Each property at both its ends makes another picture or the same, and no message. */
static void extremes(void **state)
{
    const GeglRectangle whole = {0, 0, 40, 30};
    guint count;
    GParamSpec **const specs = gegl_operation_list_properties("refocus:lens-blur", &count);
    struct graph graph;

    (void)state;
    assert_true(count >= 20);
    graph_open(&graph, graph_picture("R'G'B'A u8", 0, 0, 40, 30, 1),
               graph_map("Y' u16", 0, 0, 40, 30));
    for (guint i = 0; i < count; i++)
        for (int end = 0; end < 4; end++) {
            const char *const name = specs[i]->name;
            GeglNode *const lens = graph.lens;

            assert_non_null(g_param_spec_get_blurb(specs[i]));
            gegl_node_set(lens, "aperture", end / 2, NULL);
            if (G_IS_PARAM_SPEC_DOUBLE(specs[i])) {
                const GParamSpecDouble *const s = G_PARAM_SPEC_DOUBLE(specs[i]);
                gegl_node_set(lens, name, end % 2 ? s->maximum : s->minimum, NULL);
            } else if (G_IS_PARAM_SPEC_INT(specs[i])) {
                const GParamSpecInt *const s = G_PARAM_SPEC_INT(specs[i]);
                gegl_node_set(lens, name, end % 2 ? s->maximum : s->minimum, NULL);
            } else if (G_IS_PARAM_SPEC_ENUM(specs[i])) {
                const GEnumClass *const s = G_PARAM_SPEC_ENUM(specs[i])->enum_class;
                gegl_node_set(lens, name, end % 2 ? s->maximum : s->minimum, NULL);
            } else {
                gegl_node_set(lens, name, end % 2, NULL);
            }
            g_free(graph_take(&graph, &whole, "R'G'B'A u8"));
            assert_string_equal(graph_messages.last, "");
        }
    g_free(specs);
    graph_close(&graph);
}

/* Lights at night, of noise: what highlights need. */
static GeglBuffer *night(int width, int height)
{
    GeglBuffer *const buffer = graph_picture("R'G'B' u8", 0, 0, width, height, 1);
    guint8 *const pixels = graph_pixels(buffer, "R'G'B' u8");

    for (int i = 0; i < width * height * 3; i++) {
        const int x = i / 3 % width, y = i / 3 / width;

        pixels[i] = x % 24 < 3 && y % 24 < 3 ? 255 : pixels[i] / 8;
    }
    gegl_buffer_set(buffer, NULL, 0, babl_format("R'G'B' u8"), pixels, GEGL_AUTO_ROWSTRIDE);
    g_free(pixels);
    return buffer;
}

/* Properties at a value beside their default: the picture changes. test_lines.py has depth-edges.
 */
static void each_counts(void **state)
{
    static const struct {
        const char *name, *value;
    } values[] = {{"focus", "0.7"},
                  {"focus-x", "0.9"},
                  {"blur", "7"},
                  {"highlights", "4"},
                  {"focus-width", "0.3"},
                  {"focus-transition", "0.9"},
                  {"aperture", "star"},
                  {"aperture", "polygon"},
                  {"aperture", "heart"},
                  {"blades", "5"},
                  {"rotation", "31"},
                  {"curvature", "0.5"},
                  {"squeeze", "0.6"},
                  {"ring", "0.6"},
                  {"edge", "0.9"},
                  {"cat-eye", "0.8"},
                  {"fringe", "0.4"},
                  {"quality", "preview"},
                  {"depth-unit", "inverse"},
                  {"depth-unit", "m"},
                  {"depth-values", "linear"},
                  {"near", "0.3"},
                  {"far", "3"}};
    const GeglRectangle whole = {0, 0, 96, 72};

    (void)state;
    for (size_t i = 0; i < G_N_ELEMENTS(values); i++) {
        const char *const name = values[i].name;
        const bool iris = strcmp(name, "blades") == 0 || strcmp(name, "rotation") == 0 ||
                          strcmp(name, "curvature") == 0;
        const bool metres = strcmp(name, "near") == 0 || strcmp(name, "far") == 0;
        struct graph graph;
        guint8 *before, *after;
        GParamSpec *spec;

        graph_open(&graph, night(96, 72), graph_map("Y' u16", 0, 0, 96, 72));
        gegl_node_set(graph.lens, "aperture", iris ? 1 : 0, "focus-y", 0.5, "depth-unit",
                      metres ? 2 : 0, "focus-width", 0.02, "focus", 0.2, NULL);
        before = graph_take(&graph, &whole, "R'G'B' u8");
        spec = gegl_node_find_property(graph.lens, name);
        if (G_IS_PARAM_SPEC_DOUBLE(spec))
            gegl_node_set(graph.lens, name, g_ascii_strtod(values[i].value, NULL), NULL);
        else if (G_IS_PARAM_SPEC_ENUM(spec))
            gegl_node_set(
                graph.lens, name,
                g_enum_get_value_by_nick(G_PARAM_SPEC_ENUM(spec)->enum_class, values[i].value)
                    ->value,
                NULL);
        else
            gegl_node_set(graph.lens, name, atoi(values[i].value), NULL);
        after = graph_take(&graph, &whole, "R'G'B' u8");
        if (memcmp(before, after, 96 * 72 * 3) == 0)
            fail_msg("%s %s changes nothing", name, values[i].value);
        assert_string_equal(graph_messages.last, "");
        g_free(before);
        g_free(after);
        graph_close(&graph);
    }
}

/* Light above white is kept, unless it is said to be a photo's. */
static void light(void **state)
{
    const GeglRectangle whole = {0, 0, 40, 30};
    struct graph graph;
    float *out;
    float most = 0;

    (void)state;
    graph_open(&graph, graph_picture("RGBA float", 0, 0, 40, 30, 9),
               graph_map("Y' u16", 0, 0, 40, 30));
    gegl_node_set(graph.lens, "blur", 0.0, NULL);
    assert_true(graph_passes(&graph, "RGBA float"));
    gegl_node_set(graph.lens, "light", 1, NULL);
    out = graph_take(&graph, &whole, "RGBA float");
    for (int i = 0; i < 40 * 30 * 4; i++)
        most = fmaxf(most, out[i]);
    assert_true(most == 1);
    g_free(out);
    graph_close(&graph);
}

static int run(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extremes),
        cmocka_unit_test(each_counts),
        cmocka_unit_test(light),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void)
{
    return graph_run(run);
}
