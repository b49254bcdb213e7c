/* widen.c: the greatest values around each pixel. */
#include "edges/edges.h"

#include "support/compare.h"

enum { MOST_WIDTH = 15 };

struct widening {
    const struct rf_edges *e;
    uint16_t *plane, *rows;
    int width;
};

static void widen_row(void *context, int y, int worker)
{
    const struct widening *w = context;
    const struct rf_edges *e = w->e;
    const uint16_t *in = w->plane + y * e->stride, *row[2 * MOST_WIDTH + 1];
    uint16_t *out = w->rows + y * e->stride;
    const int inside = rf_larger(e->width - 2 * w->width, 0);

    (void)worker;
    for (int k = 0; k <= 2 * w->width; k++)
        row[k] = in + k;
    e->kernels->greatest(out + w->width, row, 2 * w->width + 1, inside);
    for (int i = 0; i < e->width - inside; i++) {
        const int x = inside > 0 && i >= w->width ? i + inside : i;
        const int x1 = rf_smaller(x + w->width, e->width - 1);

        out[x] = 0;
        for (int u = rf_larger(x - w->width, 0); u <= x1; u++)
            out[x] = in[u] > out[x] ? in[u] : out[x];
    }
}

static void widen_column(void *context, int y, int worker)
{
    const struct widening *w = context;
    const struct rf_edges *e = w->e;
    const int y1 = rf_smaller(y + w->width, e->height - 1);
    const uint16_t *row[2 * MOST_WIDTH + 1];
    int rows = 0;

    (void)worker;
    for (int v = rf_larger(y - w->width, 0); v <= y1; v++)
        row[rows++] = w->rows + v * e->stride;
    e->kernels->greatest(w->plane + y * e->stride, row, rows, e->width);
}

void rf_widen(struct rf_edges *e, uint16_t *plane, uint16_t *spare, int width)
{
    struct widening widening = {e, plane, spare, rf_smaller(width, MOST_WIDTH)};

    rf_pool_run(e->pool, widen_row, &widening, e->height);
    rf_pool_run(e->pool, widen_column, &widening, e->height);
}
