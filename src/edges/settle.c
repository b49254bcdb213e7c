/* settle.c: gives what lies beside a ramp the disparity of its surface farther in.
 *
 * Networks, JPEG and the filters of cameras overshoot beside an edge: a surface of 172 has a rim of
 * 187 there, which is not in the scene. So of the pixels beside a ramp (its band) those whose
 * surface goes on beyond the band take the mean of what is there. What has nothing like it beyond
 * the band is thin, and is left to thin.c.
 */
#include "edges/edges.h"

#include <stdlib.h>
#include <string.h>

#include "support/compare.h"
#include "support/exp_minus.h"

enum {
    MOST_REACH = 16,
    DENSE_REACH = 9, /* beyond it every other row is looked at */
    SIDE = 2 * MOST_REACH + 1,
    ALIKE = 5,  /* a surface goes on with less than a fifth of the ramp's contrast */
    FEWEST = 4, /* pixels that show it */
};
_Static_assert(SIDE *(MOST_REACH + 1) <= RF_MOST_VOTERS, "no window has more pixels");

struct settle {
    struct rf_edges *e;
    int width;          /* half of the band, pixels */
    uint16_t *contrast; /* contrast of the greatest ramp near by; 0 outside of bands */
    int reach, step;
    uint8_t nearness[SIDE][SIDE];
};

static void find_contrast(void *context, int band, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++)
        for (int x = 0; x < e->width; x++) {
            const ptrdiff_t at = y * e->stride + x;

            e->spare[at] =
                rf_is_between(e, at, e->map[at]) ? (uint16_t)(e->near[at] - e->far[at]) : 0;
        }
}

/* The greatest of 2 width + 1 values of a row, and then of a column. */
static void widen_rows(void *context, int band, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const uint16_t *in = e->spare + y * e->stride;

        for (int x = 0; x < e->width; x++) {
            const int x1 = rf_smaller(x + settle->width, e->width - 1);
            uint16_t most = 0;

            for (int u = rf_larger(x - settle->width, 0); u <= x1; u++)
                most = in[u] > most ? in[u] : most;
            e->largest[y * e->stride + x] = most;
        }
    }
}

static void widen_columns(void *context, int band, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const int y1 = rf_smaller(y + settle->width, e->height - 1);
        uint16_t *out = settle->contrast + y * e->stride;

        memset(out, 0, (size_t)e->width * sizeof *out);
        for (int v = rf_larger(y - settle->width, 0); v <= y1; v++) {
            const uint16_t *in = e->largest + v * e->stride;

            for (int x = 0; x < e->width; x++)
                out[x] = in[x] > out[x] ? in[x] : out[x];
        }
    }
}

/* Cores are the pixels beyond bands, from which the others take their disparity. */
static void find_cores(void *context, int band, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++)
        for (int x = 0; x < e->width; x++) {
            const ptrdiff_t at = y * e->stride + x;

            e->largest[at] = settle->contrast[at] ? 0 : (uint16_t)rf_larger(e->map[at], 1);
        }
}

static struct rf_core_sums look(const struct settle *settle, int x, int y)
{
    const struct rf_edges *e = settle->e;
    const ptrdiff_t at = y * e->stride + x;
    const int own = e->label[at], most = settle->contrast[at] / ALIKE;
    const int left = rf_smaller(settle->reach, x);
    const int right = rf_smaller(settle->reach, e->width - 1 - x);
    const int above = rf_smaller(settle->reach, y) / settle->step;
    const int below = rf_smaller(settle->reach, e->height - 1 - y) / settle->step;
    const struct rf_core_window window = {
        .core = e->largest + at - above * settle->step * e->stride - left,
        .stride = e->stride,
        .nearness = &settle->nearness[MOST_REACH - above * settle->step][MOST_REACH - left],
        .nearness_stride = SIDE * settle->step,
        .columns = left + 1 + right,
        .rows = above + 1 + below,
        .step = settle->step,
        .least = (uint16_t)rf_larger(own - most, 1),
        .most = (uint16_t)rf_smaller(own + most, 65535),
    };

    return e->kernels->core_sums(&window);
}

static void settle_band(void *context, int band, int worker)
{
    const struct settle *settle = context;
    struct rf_edges *e = settle->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++)
        for (int x = 0; x < e->width; x++) {
            const ptrdiff_t at = y * e->stride + x;
            struct rf_core_sums sums;

            e->is_wide[at] = !settle->contrast[at];
            if (e->is_wide[at])
                continue;
            sums = look(settle, x, y);
            if (sums.count < FEWEST || sums.weight == 0)
                continue;
            e->is_wide[at] = true;
            e->label[at] = (uint16_t)(sums.value / sums.weight);
        }
}

void rf_settle(struct rf_edges *e, double softness)
{
    struct settle settle = {.e = e, .width = (int)(0.7 * softness + 1), .contrast = e->kept};
    double spread;

    settle.reach = rf_smaller(rf_larger((int)(3.5 * softness + 0.5), 6), MOST_REACH);
    settle.step = settle.reach > DENSE_REACH ? 2 : 1;
    spread = 0.35 * settle.reach;
    for (int y = -MOST_REACH; y <= MOST_REACH; y++)
        for (int x = -MOST_REACH; x <= MOST_REACH; x++)
            settle.nearness[MOST_REACH + y][MOST_REACH + x] =
                (uint8_t)(255 * rf_exp_minus((x * x + y * y) / (2 * spread * spread)) + 0.5);
    rf_pool_run(e->pool, find_contrast, &settle, rf_edge_bands(e));
    rf_pool_run(e->pool, widen_rows, &settle, rf_edge_bands(e));
    rf_pool_run(e->pool, widen_columns, &settle, rf_edge_bands(e));
    rf_pool_run(e->pool, find_cores, &settle, rf_edge_bands(e));
    rf_pool_run(e->pool, settle_band, &settle, rf_edge_bands(e));
}
