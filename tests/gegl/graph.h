/* graph.h: a photo and a depth map in memory go through the operation. */
#ifndef TESTS_GEGL_GRAPH_H
#define TESTS_GEGL_GRAPH_H

#include <stdbool.h>
#include <gegl.h>

struct graph {
    GeglNode *root, *lens;
    GeglBuffer *photo, *depth; /* depth: NULL without one */
};

/* A buffer of made-up pixels: integers of any code, floats up to `most`. */
GeglBuffer *graph_picture(const char *format, int x, int y, int width, int height, float most);
/* A map whose left half is far, the right one near; with a ramp in each. */
GeglBuffer *graph_map(const char *format, int x, int y, int width, int height);

/* The graph takes the buffers over. Set properties of the operation in `lens`. */
void graph_open(struct graph *graph, GeglBuffer *photo, GeglBuffer *depth);
void graph_close(struct graph *graph);

/* A rectangle of the result in this format, to be freed by g_free(). */
void *graph_take(struct graph *graph, const GeglRectangle *part, const char *format);

/* The pixels of a buffer, to be freed by g_free(); whether what comes out of the graph is what went
 * in. */
void *graph_pixels(GeglBuffer *buffer, const char *format);
bool graph_passes(struct graph *graph, const char *format);

/* Messages of the operation since the last call, and the last one of them. */
extern struct graph_messages {
    int count;
    char last[256];
} graph_messages;

/* Run tests between GEGL's beginning and end: how many failed, a buffer that is not freed is one.
 */
int graph_run(int (*run)(void));

#endif
