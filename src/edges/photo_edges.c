/* photo_edges.c: finds the edges of a disparity map, and how much of an edge the photo has there.
 */
#include "edges/edges.h"

#include <string.h>

#include "support/compare.h"

enum {
    MARGIN = 12,        /* pixels from the sides, within which no edge is looked for */
    LEAST_SLOPE = 393,  /* 0.006 a pixel */
    LEAST_RANGE = 2621, /* 0.04 within 5 x 5 pixels */
};

/* ----- planes: nothing is looked for at their sides, where no value is written ----- */

struct planes {
    struct rf_edges *e;
    const uint8_t *codes;        /* one channel of the photo */
    const uint16_t *disparities; /* or these */
};

static void smooth_row(void *context, int item, int worker)
{
    const struct planes *planes = context;
    const struct rf_edges *e = planes->e;
    const ptrdiff_t s = e->stride, at = (item + 1) * s + 1;

    (void)worker;
    if (planes->codes) {
        const uint8_t *here = planes->codes + at, *const row[3] = {here - s, here, here + s};

        e->kernels->binomial8(e->spare + at, row, e->width - 2);
    } else {
        const uint16_t *here = planes->disparities + at, *const row[3] = {here - s, here, here + s};

        e->kernels->binomial16(e->spare + at, row, e->width - 2);
    }
}

static void gradient_row(void *context, int item, int worker)
{
    const struct rf_edges *e = context;
    const ptrdiff_t s = e->stride, at = (item + 2) * s + 2;
    const uint16_t *here = e->spare + at, *const row[3] = {here - s, here, here + s};

    (void)worker;
    e->kernels->photo_gradient(e->gradient.x + at, e->gradient.y + at, row, e->width - 4);
}

static void slope_row(void *context, int item, int worker)
{
    const struct rf_edges *e = context;
    const ptrdiff_t s = e->stride, at = (item + 2) * s + 2;
    const uint16_t *here = e->spare + at, *const row[3] = {here - s, here, here + s};

    (void)worker;
    e->kernels->map_slope(e->largest + at, row, e->width - 4);
}

void rf_find_photo_gradient(struct rf_edges *e)
{
    const size_t bytes = (size_t)e->stride * (size_t)e->height * sizeof *e->gradient.x;

    memset(e->gradient.x, 0, bytes);
    memset(e->gradient.y, 0, bytes);
    for (int c = 0; c < 3; c++) {
        struct planes planes = {.e = e, .codes = e->colour[c]};

        rf_pool_run(e->pool, smooth_row, &planes, e->height - 2);
        rf_pool_run(e->pool, gradient_row, e, e->height - 4);
    }
}

int rf_photo_edge_at(const struct rf_edges *e, const struct rf_map_edge *edge, int x, int y)
{
    const ptrdiff_t at = y * e->stride + x;
    const int across = e->gradient.x[at] * edge->normal_x + e->gradient.y[at] * edge->normal_y;

    return rf_smaller((across < 0 ? -across : across) >> 7, RF_MOST_PHOTO_EDGE);
}

/* ----- edges of the map ----- */

/* Sobel's operator: eight times the slope. */
static int slope_x(const uint16_t *p, ptrdiff_t s)
{
    return p[1 - s] + 2 * p[1] + p[1 + s] - (p[-1 - s] + 2 * p[-1] + p[-1 + s]);
}

static int slope_y(const uint16_t *p, ptrdiff_t s)
{
    return p[s - 1] + 2 * p[s] + p[s + 1] - (p[-s - 1] + 2 * p[-s] + p[-s + 1]);
}

/* The slope between pixels, at an offset of at most one pixel in Q7: 16384 times it. */
static int64_t slope_at(const struct rf_edges *e, int x, int y, int right, int down)
{
    const int u = x + (right < 0 ? -1 : 0), v = y + (down < 0 ? -1 : 0);
    const int across = right < 0 ? right + 128 : right, along = down < 0 ? down + 128 : down;
    const uint16_t *p = e->largest + v * e->stride + u;
    const int64_t above = p[0] * (128 - across) + p[1] * across;
    const int64_t below = p[e->stride] * (128 - across) + p[e->stride + 1] * across;

    return above * (128 - along) + below * along;
}

static bool is_step(const struct rf_edges *e, const uint16_t *plane, int x, int y)
{
    int least = 65535, most = 0;

    for (int v = y - 2; v <= y + 2; v++)
        for (int u = x - 2; u <= x + 2; u++) {
            least = rf_smaller(least, plane[v * e->stride + u]);
            most = rf_larger(most, plane[v * e->stride + u]);
        }
    return most - least > LEAST_RANGE;
}

/* A pixel that is steep, and steeper than to either side, as Canny has it. */
static bool is_edge(const struct rf_edges *e, const uint16_t *smooth, int x, int y,
                    struct rf_map_edge *edge)
{
    const ptrdiff_t at = y * e->stride + x;
    const int slope = e->largest[at];

    *edge = (struct rf_map_edge){
        .x = (uint16_t)x,
        .y = (uint16_t)y,
        .normal_x = (int16_t)(slope_x(smooth + at, e->stride) * 16 / slope),
        .normal_y = (int16_t)(slope_y(smooth + at, e->stride) * 16 / slope),
    };
    edge->normal_x = (int16_t)rf_smaller(rf_larger(edge->normal_x, -127), 127);
    edge->normal_y = (int16_t)rf_smaller(rf_larger(edge->normal_y, -127), 127);
    return (int64_t)slope << 14 >= slope_at(e, x, y, edge->normal_x, edge->normal_y) &&
           (int64_t)slope << 14 > slope_at(e, x, y, -edge->normal_x, -edge->normal_y);
}

/* Adds those of n pixels of a row, if there is room. */
static void add_edges(struct rf_edges *e, const uint16_t *plane, int x, int y, int n)
{
    const uint16_t *slope = e->largest + y * e->stride + x;
    struct rf_map_edge edge;

    for (int i = 0; i < n && e->edges < e->most_edges; i++)
        if (slope[i] > LEAST_SLOPE && is_edge(e, e->spare, x + i, y, &edge) &&
            is_step(e, plane, x + i, y))
            e->edge[e->edges++] = edge;
}

void rf_find_map_edges(struct rf_edges *e, const uint16_t *plane)
{
    struct planes planes = {.e = e, .disparities = plane};

    rf_pool_run(e->pool, smooth_row, &planes, e->height - 2);
    rf_pool_run(e->pool, slope_row, e, e->height - 4);
    e->edges = 0;
    for (int y = MARGIN; y < e->height - MARGIN && !rf_run_cancelled(e->pool->run); y++)
        for (int x = MARGIN, n; x < e->width - MARGIN; x += n) {
            n = rf_smaller(RF_EDGE_BLOCK - x % RF_EDGE_BLOCK, e->width - MARGIN - x);
            if (rf_edge_is_rough(e, x, y))
                add_edges(e, plane, x, y, n);
        }
    if (e->edges == e->most_edges) /* noise */
        e->edges = 0;
}
