/* test_operation.c: the operation in graphs of GEGL makes what the library makes. */
#include <stdint.h>
#include "unit_test.h"
#include <math.h>
#include <string.h>
#include <refocus/refocus.h>
#include "graph.h"

enum { X = -5, Y = 9 };

/* The library's own picture of it, with the operation's defaults. */
static void *expect(GeglBuffer *buffer, GeglBuffer *depth, const char *babl, uint32_t format,
                    uint32_t out_format, float focus, float blur)
{
    const GeglRectangle *const size = gegl_buffer_get_extent(buffer);
    const GeglRectangle *const map_size = gegl_buffer_get_extent(depth);
    const int32_t width = size->width, height = size->height;
    void *const in = g_malloc((size_t)refocus_image_bytes(format, width, height));
    void *const out = g_malloc((size_t)refocus_image_bytes(out_format, width, height));
    guint16 *const map = g_new(guint16, (size_t)(map_size->width * map_size->height));
    const struct refocus_image photo = refocus_image_planar(format, in, width, height);
    const struct refocus_image result = refocus_image_planar(out_format, out, width, height);
    const struct refocus_disparity disparity =
        refocus_disparity16(map, map_size->width, map_size->height, 2 * map_size->width);
    struct refocus_renderer_params params = refocus_renderer_params_default(width, height, blur);
    struct refocus_settings settings = refocus_settings_default(focus, blur);
    struct refocus_scene scene = refocus_scene_default(&photo, &disparity);
    struct refocus_renderer *renderer;

    gegl_buffer_get(buffer, NULL, 1, babl_format(babl), in, GEGL_AUTO_ROWSTRIDE, GEGL_ABYSS_NONE);
    gegl_buffer_get(depth, NULL, 1, babl_format("Y' u16"), map, GEGL_AUTO_ROWSTRIDE,
                    GEGL_ABYSS_NONE);
    params.thin = 1;
    params.deep = out_format != REFOCUS_FORMAT_RGB8 && out_format != REFOCUS_FORMAT_RGBA8;
    params.depth_edges = scene.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
    settings.thin.enabled = 1;
    settings.highlights.estimate = 1;
    assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &settings, &result), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    g_free(map);
    g_free(in);
    return out;
}

/* Format of the photo, that which the library is to take it as, and that which comes out. */
static const struct kind {
    const char *stored, *taken, *given;
    uint32_t in, out;
    float most;
} kinds[] = {
    {"R'G'B'A u8", "R'G'B'A u8", "R'G'B'A u8", REFOCUS_FORMAT_RGBA8, REFOCUS_FORMAT_RGBA8, 1},
    {"R'G'B' u8", "R'G'B' u8", "R'G'B' u8", REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, 1},
    {"Y' u8", "R'G'B' u8", "R'G'B' u8", REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, 1},
    {"R'G'B'A u16", "R'G'B'A u16", "R'G'B'A u16", REFOCUS_FORMAT_RGBA16, REFOCUS_FORMAT_RGBA16, 1},
    {"R'G'B' u16", "R'G'B' u16", "R'G'B' u16", REFOCUS_FORMAT_RGB16, REFOCUS_FORMAT_RGB16, 1},
    {"RGBA float", "RGBA float", "RGBA float", REFOCUS_FORMAT_RGBA_FLOAT, REFOCUS_FORMAT_RGBA_FLOAT,
     9},
    {"RGB float", "RGB float", "RGB float", REFOCUS_FORMAT_RGB_FLOAT, REFOCUS_FORMAT_RGB_FLOAT, 9},
    {"RGBA float", "R'G'B'A u16", "RGBA float", REFOCUS_FORMAT_RGBA16, REFOCUS_FORMAT_RGBA_FLOAT,
     1},
    {"RGB float", "R'G'B' u16", "RGB float", REFOCUS_FORMAT_RGB16, REFOCUS_FORMAT_RGB_FLOAT, 1},
};

/* Any format and size: byte by byte what the library makes of it. */
static void same_as_the_library(void **state)
{
    static const int sizes[][2] = {{64, 48}, {1, 1}, {1, 37}, {301, 2}, {33, 21}};

    (void)state;
    for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++)
        for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
            const int width = sizes[i][0], height = sizes[i][1];
            const GeglRectangle whole = {X, Y, width, height};
            struct graph graph;
            void *ours, *theirs;

            graph_open(&graph, graph_picture(kinds[k].stored, X, Y, width, height, kinds[k].most),
                       graph_map("Y' u16", X, Y, width, height));
            gegl_node_set(graph.lens, "focus", 0.9, "blur", 12.0, NULL);
            ours = graph_take(&graph, &whole, kinds[k].given);
            theirs = expect(graph.photo, graph.depth, kinds[k].taken, kinds[k].in, kinds[k].out,
                            0.9f, 12);
            assert_memory_equal(ours, theirs, refocus_image_bytes(kinds[k].out, width, height));
            assert_string_equal(graph_messages.last, "");
            g_free(ours);
            g_free(theirs);
            graph_close(&graph);
        }
}

/* A map of any format and size, and one without an end, stand for the same depths. */
static void maps(void **state)
{
    static const char *const formats[] = {"Y' u16", "R'G'B'A u16", "Y' float", "R'G'B' float"};
    const GeglRectangle whole = {X, Y, 64, 48};
    const size_t bytes = 64 * 48 * 3;

    (void)state;
    for (size_t i = 0; i < G_N_ELEMENTS(formats); i++)
        for (int half = 0; half < 2; half++) {
            GeglBuffer *const map = graph_map("Y' u16", 0, 0, 64 >> half, 48 >> half);
            struct graph graph;
            void *ours, *theirs;

            graph_open(&graph, graph_picture("R'G'B' u8", X, Y, 64, 48, 1),
                       graph_map(formats[i], 7, 3, 64 >> half, 48 >> half));
            gegl_node_set(graph.lens, "focus", 0.9, "blur", 12.0, NULL);
            ours = graph_take(&graph, &whole, "R'G'B' u8");
            theirs = expect(graph.photo, map, "R'G'B' u8", REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8,
                            0.9f, 12);
            assert_memory_equal(ours, theirs, bytes);
            g_free(ours);
            g_free(theirs);
            g_object_unref(map);
            graph_close(&graph);
        }
}

/* One depth everywhere, by a node without an end: all in focus, or all blurred. */
static void endless_map(void **state)
{
    struct graph graph;
    GeglColor *const white = gegl_color_new("white");
    GeglNode *colour;

    (void)state;
    graph_open(&graph, graph_picture("RGBA float", X, Y, 40, 30, 9), NULL);
    colour = gegl_node_new_child(graph.root, "operation", "gegl:color", "value", white, NULL);
    gegl_node_connect_to(colour, "output", graph.lens, "aux");
    gegl_node_set(graph.lens, "focus", 1.0, NULL);
    assert_true(graph_passes(&graph, "RGBA float"));
    gegl_node_set(graph.lens, "focus", 0.0, NULL);
    assert_false(graph_passes(&graph, "RGBA float"));
    assert_string_equal(graph_messages.last, "");
    graph_close(&graph);
    g_object_unref(white);
}

static void part_of_the_whole(void **state)
{
    const GeglRectangle whole = {X, Y, 90, 70}, part = {X + 31, Y + 8, 17, 29};
    struct graph graph;
    guint8 *all, *some;

    (void)state;
    graph_open(&graph, graph_picture("R'G'B'A u8", X, Y, 90, 70, 1),
               graph_map("Y' u16", X, Y, 90, 70));
    some = graph_take(&graph, &part, "R'G'B'A u8");
    all = graph_take(&graph, &whole, "R'G'B'A u8");
    for (int y = 0; y < part.height; y++)
        assert_memory_equal(some + y * part.width * 4, all + ((y + 8) * whole.width + 31) * 4,
                            (size_t)part.width * 4);
    g_free(all);
    g_free(some);
    graph_close(&graph);
}

/* A change of the photo reaches as far as the blur: what GEGL has kept of it all is made anew. */
static void change(void **state)
{
    const GeglRectangle whole = {0, 0, 64, 48}, left = {0, 0, 16, 48};
    const guint8 white[16 * 48] = {255};
    struct graph graph;
    GeglNode *kept;
    guint8 *before = g_malloc(64 * 48), *after = g_malloc(64 * 48);

    (void)state;
    graph_open(&graph, graph_picture("Y' u8", 0, 0, 64, 48, 1), graph_map("Y' u16", 0, 0, 64, 48));
    gegl_node_set(graph.lens, "focus", 1.0, "blur", 30.0, NULL);
    kept = gegl_node_new_child(graph.root, "operation", "gegl:nop", NULL);
    gegl_node_link(graph.lens, kept);
    gegl_node_blit(kept, 1, &whole, babl_format("Y' u8"), before, 0, GEGL_BLIT_CACHE);
    gegl_buffer_set(graph.photo, &left, 0, babl_format("Y' u8"), white, GEGL_AUTO_ROWSTRIDE);
    gegl_node_blit(kept, 1, &whole, babl_format("Y' u8"), after, 0, GEGL_BLIT_CACHE);
    assert_int_not_equal(memcmp(before + 24 * 64 + 20, after + 24 * 64 + 20, 8), 0);
    g_free(before);
    g_free(after);
    graph_close(&graph);
}

/* Codes by another curve than sRGB's come back to within a code. */
static void other_space(void **state)
{
    const Babl *const space = babl_space("Adobish");
    const Babl *const format = babl_format_with_space("R'G'B' u8", space);
    const GeglRectangle whole = {0, 0, 32, 32};
    struct graph graph;
    guint8 in[32 * 32 * 3], out[sizeof in];
    GeglBuffer *const photo = gegl_buffer_new(&whole, format);

    (void)state;
    for (size_t i = 0; i < sizeof in; i++)
        in[i] = (guint8)(i * 37 % 256);
    gegl_buffer_set(photo, NULL, 0, format, in, GEGL_AUTO_ROWSTRIDE);
    graph_open(&graph, photo, graph_map("Y' u16", 0, 0, 32, 32));
    gegl_node_set(graph.lens, "blur", 0.0, NULL);
    gegl_node_blit(graph.lens, 1, &whole, format, out, GEGL_AUTO_ROWSTRIDE, GEGL_BLIT_DEFAULT);
    for (size_t i = 0; i < sizeof in; i++)
        assert_in_range(out[i] - in[i] + 1, 0, 2);
    graph_close(&graph);
}

/* A photo that cannot be refocused goes through as it is, and one line says why. */
static void refused(void **state)
{
    const guint16 clear[2] = {30000, 0};
    struct graph graph;
    GeglBuffer *empty;

    (void)state;
    graph_open(&graph, graph_picture("R'G'B'A u8", X, Y, 20, 10, 1), NULL);
    assert_true(graph_passes(&graph, "R'G'B'A u8"));
    assert_true(graph_passes(&graph, "R'G'B'A u8"));
    assert_int_equal(graph_messages.count, 1);
    assert_string_equal(
        graph_messages.last,
        "refocus:lens-blur: choose a depth map as aux input; without one nothing is blurred");
    graph_close(&graph);

    graph_open(&graph, graph_picture("R'G'B'A u8", X, Y, 20, 10, 1),
               graph_map("Y' u16", X, Y, 20, 10));
    gegl_node_set(graph.lens, "depth-unit", 2, "near", 8.0, "far", 3.0, NULL);
    assert_true(graph_passes(&graph, "R'G'B'A u8"));
    assert_int_equal(graph_messages.count, 1);
    assert_non_null(strstr(graph_messages.last, "near has to be less than far"));
    graph_close(&graph);

    empty = gegl_buffer_new(GEGL_RECTANGLE(0, 0, 20, 10), babl_format("Y'A u16"));
    gegl_buffer_set_color_from_pixel(empty, NULL, clear, babl_format("Y'A u16"));
    graph_open(&graph, graph_picture("R'G'B'A u8", 0, 0, 20, 10, 1), empty);
    assert_true(graph_passes(&graph, "R'G'B'A u8"));
    assert_non_null(strstr(graph_messages.last, "no sample of the depth map holds a value"));
    graph_close(&graph);
}

/* Sides that the library does not take, and a photo without an end. */
static void refused_sizes(void **state)
{
    GeglColor *const white = gegl_color_new("white");
    struct graph graph;

    (void)state;
    graph_open(&graph, graph_picture("Y' u8", 0, 0, 65536, 1, 1), graph_map("Y' u8", 0, 0, 2, 1));
    assert_true(graph_passes(&graph, "Y' u8"));
    assert_non_null(strstr(graph_messages.last, "has a side of more than 65535 pixels"));
    graph_close(&graph);

    graph_open(&graph, graph_picture("Y' u8", 0, 0, 4, 4, 1), graph_map("Y' u8", 0, 0, 4, 4));
    gegl_node_link(gegl_node_new_child(graph.root, "operation", "gegl:color", "value", white, NULL),
                   graph.lens);
    g_free(graph_take(&graph, GEGL_RECTANGLE(0, 0, 9, 9), "Y' u8"));
    assert_non_null(strstr(graph_messages.last, "the photo has no end; crop it first"));
    graph_close(&graph);
    g_object_unref(white);
}

/* Floats that are no light harm nothing, and where nothing is blurred they stay what they are. */
static void odd_floats(void **state)
{
    const float odd[] = {(float)NAN, INFINITY, -INFINITY, -3, 1e30f, 1e-30f, -0.0f, 0.5f};
    const GeglRectangle whole = {0, 0, 32, 32};
    struct graph graph;
    float *pixels;

    (void)state;
    graph_open(&graph, graph_picture("RGBA float", 0, 0, 32, 32, 2),
               graph_map("Y' u16", 0, 0, 32, 32));
    pixels = graph_pixels(graph.photo, "RGBA float");
    for (size_t i = 0; i < 32 * 32 * 4; i += 3)
        pixels[i] = odd[i / 3 % G_N_ELEMENTS(odd)];
    gegl_buffer_set(graph.photo, NULL, 0, babl_format("RGBA float"), pixels, GEGL_AUTO_ROWSTRIDE);
    g_free(pixels);
    g_free(graph_take(&graph, &whole, "RGBA float"));
    assert_string_equal(graph_messages.last, "");
    gegl_node_set(graph.lens, "blur", 0.0, NULL);
    assert_true(graph_passes(&graph, "RGBA float"));
    graph_close(&graph);
}

/* Where the map is clear it says nothing: depth comes from around, at its silhouette from the side
 * that looks alike. */
static void holes(void **state)
{
    const GeglRectangle hole[] = {{8, 8, 10, 10}, {32, 8, 10, 10}};
    const GeglRectangle whole = {0, 0, 64, 48}, near = {32, 0, 32, 48};
    const guint16 clear[2] = {65535, 0};
    const guint8 red[3] = {250, 20, 20};
    struct graph graph;
    guint8 *with, *without;

    (void)state;
    for (int k = 0; k < 2; k++) {
        graph_open(&graph, graph_picture("R'G'B' u8", 0, 0, 64, 48, 1),
                   graph_map("Y'A u16", 0, 0, 64, 48));
        gegl_buffer_set_color_from_pixel(graph.photo, &near, red, babl_format("R'G'B' u8"));
        gegl_node_set(graph.lens, "focus", 0.05, "depth-edges", FALSE, NULL);
        without = graph_take(&graph, &whole, "R'G'B' u8");
        gegl_buffer_set_color_from_pixel(graph.depth, &hole[k], clear, babl_format("Y'A u16"));
        with = graph_take(&graph, &whole, "R'G'B' u8");
        for (size_t i = 0; i < 64 * 48 * 3; i++)
            assert_in_range(with[i] - without[i] + 2, 0, 4);
        g_free(with);
        g_free(without);
        graph_close(&graph);
    }
}

static int run(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_the_library),
        cmocka_unit_test(maps),
        cmocka_unit_test(endless_map),
        cmocka_unit_test(part_of_the_whole),
        cmocka_unit_test(change),
        cmocka_unit_test(other_space),
        cmocka_unit_test(refused),
        cmocka_unit_test(refused_sizes),
        cmocka_unit_test(odd_floats),
        cmocka_unit_test(holes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void)
{
    return graph_run(run);
}
