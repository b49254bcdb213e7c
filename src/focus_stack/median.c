/* median.c: depth along silhouettes becomes the weighted median of what is around it.
 *
 * Votes (fill.c) go along rows and columns, and leave combs and teeth along silhouettes, a few
 * samples long, where one row is told and the next one is not. The photo in focus everywhere shows
 * them as lines. So, where depth changes by much close by, a sample takes the weighted median of
 * the depth around it, each weighted by how alike it is in colour (Ma et al. 2013): surfaces stay
 * as they are, and end where the colour of the guide does. Of three frames and fewer, thin things
 * are few samples among what is told wrongly around them, and would go.
 */
#include "focus_stack/focus_stack.h"

#include <string.h>

enum {
    REACH = 4, /* samples */
    SIDE = 2 * REACH + 1,
    NEAR = 2, /* samples within which depth changes by 1 / APART of all depths */
    APART = 8,
    EDGE = 16, /* codes of difference that halve a weight */
    ONE = 256, /* the weight of a like one */
};

static bool is_beside_an_edge(const struct refocus_stack *s, int x, int y)
{
    const int apart = 256 * (s->depths - 1) / APART;
    const uint16_t *own = s->depth + (ptrdiff_t)y * s->columns + x;

    for (int d = 1; d <= NEAR; d++)
        if ((x >= d && abs(own[-d] - own[0]) > apart) ||
            (x + d < s->columns && abs(own[d] - own[0]) > apart) ||
            (y >= d && abs(own[-d * s->columns] - own[0]) > apart) ||
            (y + d < s->rows && abs(own[d * s->columns] - own[0]) > apart))
            return true;
    return false;
}

static uint16_t median_at(const struct refocus_stack *s, int x, int y)
{
    const ptrdiff_t own = (ptrdiff_t)y * s->columns + x;
    uint16_t depth[SIDE * SIDE];
    int weight[SIDE * SIDE], n = 0, all = 0, sum = 0;

    for (int v = y < REACH ? -y : -REACH; v <= REACH && y + v < s->rows; v++)
        for (int u = x < REACH ? -x : -REACH; u <= REACH && x + u < s->columns; u++) {
            const ptrdiff_t at = own + v * s->columns + u;
            const int d = rf_stack_difference(s->guide + 3 * own, s->guide + 3 * at);
            const int w = ONE * EDGE * EDGE / (EDGE * EDGE + d * d);
            int i = n++;

            for (; i > 0 && depth[i - 1] > s->depth[at]; i--) {
                depth[i] = depth[i - 1];
                weight[i] = weight[i - 1];
            }
            depth[i] = s->depth[at];
            weight[i] = w;
            all += w;
        }
    for (int i = 0; i < n; i++) {
        sum += weight[i];
        if (2 * sum >= all)
            return depth[i];
    }
    return depth[n - 1];
}

static void median_row(void *context, int y, int worker)
{
    const struct refocus_stack *s = context;
    uint16_t *out = s->moved + (ptrdiff_t)y * s->columns;

    (void)worker;
    for (int x = 0; x < s->columns; x++)
        out[x] = is_beside_an_edge(s, x, y) ? median_at(s, x, y)
                                            : s->depth[(ptrdiff_t)y * s->columns + x];
}

void rf_stack_median(struct refocus_stack *s)
{
    rf_pool_run(s->pool, median_row, s, s->rows);
    memcpy(s->depth, s->moved, (size_t)s->columns * (size_t)s->rows * sizeof *s->depth);
}
