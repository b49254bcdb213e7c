#include "graph.h"

#include <stdio.h>
#include <string.h>
#include "operation.h"

/* GEGL's library has this function, and none of its headers. */
int gegl_buffer_leaks(void);

struct graph_messages graph_messages;

static void hear(const gchar *domain, GLogLevelFlags level, const gchar *text, gpointer data)
{
    (void)domain, (void)level, (void)data;
    graph_messages.count++;
    g_strlcpy(graph_messages.last, text, sizeof graph_messages.last);
}

static bool is_of(const Babl *format, const char *type)
{
    return babl_format_get_type(format, 0) == babl_type(type);
}

GeglBuffer *graph_picture(const char *format, int x, int y, int width, int height, float most)
{
    const Babl *const babl = babl_format(format);
    const size_t bytes = (size_t)babl_format_get_bytes_per_pixel(babl) * (size_t)(width * height);
    GeglBuffer *const buffer = gegl_buffer_new(GEGL_RECTANGLE(x, y, width, height), babl);
    guint8 *const pixels = g_malloc(bytes);
    guint32 seed = 7;

    for (size_t i = 0; i < bytes; i++) {
        seed = seed * 1664525 + 1013904223;
        pixels[i] = (guint8)(seed >> 24);
    }
    if (is_of(babl, "float"))
        for (size_t i = 0; i < bytes / sizeof(float); i++) {
            seed = seed * 1664525 + 1013904223;
            ((float *)(void *)pixels)[i] = (float)(seed >> 8) / (float)(1 << 24) * most;
        }
    gegl_buffer_set(buffer, NULL, 0, babl, pixels, GEGL_AUTO_ROWSTRIDE);
    g_free(pixels);
    return buffer;
}

GeglBuffer *graph_map(const char *format, int x, int y, int width, int height)
{
    GeglBuffer *const buffer =
        gegl_buffer_new(GEGL_RECTANGLE(x, y, width, height), babl_format(format));
    guint16 *const samples = g_new(guint16, (size_t)(width * height));

    for (int i = 0; i < width * height; i++)
        samples[i] = (guint16)(i % width < width / 2 ? 3000 + i % 97 : 60000 - i % 83);
    gegl_buffer_set(buffer, NULL, 0, babl_format("Y' u16"), samples, GEGL_AUTO_ROWSTRIDE);
    g_free(samples);
    return buffer;
}

static GeglNode *source(struct graph *graph, GeglBuffer *buffer)
{
    return gegl_node_new_child(graph->root, "operation", "gegl:buffer-source", "buffer", buffer,
                               NULL);
}

void graph_open(struct graph *graph, GeglBuffer *photo, GeglBuffer *depth)
{
    graph->photo = photo;
    graph->depth = depth;
    graph->root = gegl_node_new();
    graph->lens = gegl_node_new_child(graph->root, "operation", "refocus:lens-blur", NULL);
    gegl_node_link(source(graph, photo), graph->lens);
    if (depth)
        gegl_node_connect_to(source(graph, depth), "output", graph->lens, "aux");
    graph_messages.count = 0;
    graph_messages.last[0] = '\0';
}

void graph_close(struct graph *graph)
{
    g_object_unref(graph->root);
    g_object_unref(graph->photo);
    if (graph->depth)
        g_object_unref(graph->depth);
}

void *graph_take(struct graph *graph, const GeglRectangle *part, const char *format)
{
    const Babl *const babl = babl_format(format);
    void *const pixels = g_malloc0((size_t)babl_format_get_bytes_per_pixel(babl) *
                                   (size_t)(part->width * part->height));

    gegl_node_blit(graph->lens, 1, part, babl, pixels, GEGL_AUTO_ROWSTRIDE, GEGL_BLIT_DEFAULT);
    return pixels;
}

void *graph_pixels(GeglBuffer *buffer, const char *format)
{
    const GeglRectangle *const size = gegl_buffer_get_extent(buffer);
    void *const pixels = g_malloc((size_t)babl_format_get_bytes_per_pixel(babl_format(format)) *
                                  (size_t)(size->width * size->height));

    gegl_buffer_get(buffer, NULL, 1, babl_format(format), pixels, GEGL_AUTO_ROWSTRIDE,
                    GEGL_ABYSS_NONE);
    return pixels;
}

bool graph_passes(struct graph *graph, const char *format)
{
    const GeglRectangle *const size = gegl_buffer_get_extent(graph->photo);
    void *const out = graph_take(graph, size, format);
    void *const in = graph_pixels(graph->photo, format);
    const bool same = memcmp(out, in,
                             (size_t)babl_format_get_bytes_per_pixel(babl_format(format)) *
                                 (size_t)(size->width * size->height)) == 0;

    g_free(in);
    g_free(out);
    return same;
}

int graph_run(int (*run)(void))
{
    int failed;

    gegl_init(NULL, NULL);
    rf_gegl_operation_register(NULL);
    g_log_set_handler("GEGL", G_LOG_LEVEL_MESSAGE, hear, NULL);
    failed = run();
    if (gegl_buffer_leaks() != 0) {
        fprintf(stderr, "%d buffers are not freed\n", gegl_buffer_leaks());
        failed++;
    }
    gegl_exit();
    return failed;
}
