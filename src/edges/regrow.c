/* regrow.c: makes the near surfaces of a disparity map smaller or larger. */
#include "edges/edges.h"

#include <stdlib.h>

#include "support/compare.h"

struct growth {
    struct rf_edges *e;
    int grown;
};

/* A pixel that becomes far by mistake leaves a wire with gaps, one that becomes near by mistake
 * costs less: the disc that makes near surfaces smaller holds no pixel beyond its radius, the one
 * that makes them larger some that are a quarter of a pixel beyond. */
static bool in_disc(const struct growth *growth, int x, int y)
{
    const int grown = growth->grown;

    return x * x + y * y <= grown * grown + (grown < 0 ? -grown / 2 : 0);
}

/* The greatest of the turned disparities around a pixel, for those beside the sides. */
static uint16_t greatest_around(const struct growth *growth, int x, int y)
{
    const struct rf_edges *e = growth->e;
    const int radius = abs(growth->grown);
    const int y1 = rf_smaller(y + radius, e->height - 1);
    const int x0 = rf_larger(x - radius, 0), x1 = rf_smaller(x + radius, e->width - 1);
    uint16_t most = 0;

    for (int v = rf_larger(y - radius, 0); v <= y1; v++)
        for (int u = x0; u <= x1; u++)
            if (in_disc(growth, u - x, v - y) && e->label[v * e->stride + u] > most)
                most = e->label[v * e->stride + u];
    return most;
}

/* The disparities of a map that is to be larger, or of one that is to be smaller from 65535 down.
 */
static void load_turned(void *context, int y, int worker)
{
    const struct growth *growth = context;
    const struct rf_edges *e = growth->e;
    const uint16_t *map = e->map + y * e->stride, turn = growth->grown > 0 ? 0xffff : 0;
    uint16_t *out = e->label + y * e->stride;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        out[x] = map[x] ^ turn;
}

/* The greatest of these within a disc. What differs little from the pixel's own belongs to its
 * surface: slopes stay. */
static void regrow_row(void *context, int y, int worker)
{
    const struct growth *growth = context;
    const struct rf_edges *e = growth->e;
    const int radius = abs(growth->grown), inside = rf_larger(e->width - 2 * radius, 0);
    const uint16_t *map = e->map + y * e->stride, turn = growth->grown > 0 ? 0xffff : 0;
    const uint16_t *row[(2 * RF_MOST_GROWN + 1) * (2 * RF_MOST_GROWN + 1)];
    uint16_t *out = e->spare + y * e->stride;
    int rows = 0;

    (void)worker;
    for (int v = rf_larger(-radius, -y); v <= rf_smaller(radius, e->height - 1 - y); v++)
        for (int u = -radius; u <= radius; u++)
            if (in_disc(growth, u, v))
                row[rows++] = e->label + (y + v) * e->stride + radius + u;
    e->kernels->greatest(out + radius, row, rows, inside);
    for (int i = 0; i < e->width - inside; i++) {
        const int x = inside > 0 && i >= radius ? i + inside : i;

        out[x] = greatest_around(growth, x, y);
    }
    for (int x = 0; x < e->width; x++) {
        const uint16_t found = out[x] ^ turn;

        out[x] = abs(found - map[x]) > RF_EDGE_STEP ? found : map[x];
    }
}

void rf_regrow(struct rf_edges *e, int grown)
{
    struct growth growth = {.e = e, .grown = grown};

    rf_pool_run(e->pool, load_turned, &growth, e->height);
    rf_pool_run(e->pool, regrow_row, &growth, e->height);
    rf_copy_plane(e, e->map, e->spare);
}
