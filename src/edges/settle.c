/* settle.c: gives what lies beside a ramp the disparity of its surface farther in.
 *
 * Networks, JPEG and the filters of cameras overshoot beside an edge: a surface of 172 has an edge
 * of 187 there, which is not in the scene. So of the pixels beside a ramp (its band) those whose
 * surface goes on beyond the band take the mean of what is there. What has nothing like it beyond
 * the band is thin, and is left to thin.c.
 */
#include "edges/window.h"

#include <string.h>

enum {
    ALIKE = 5,  /* a surface goes on with less than a fifth of the ramp's contrast */
    FEWEST = 2, /* pixels that show it, in every other row */
};

struct settle {
    struct rf_edges *e;
    uint16_t *contrast; /* contrast of the greatest ramp near by; 0 outside of bands */
    uint16_t *core;     /* disparity beyond bands; 0 in them */
    struct rf_vote_shape shape;
};

static void find_contrast(void *context, int y, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    const ptrdiff_t at = y * e->stride;
    bool rough;

    (void)worker;
    memset(settle->contrast + at, 0, (size_t)e->width * sizeof *e->near);
    for (int x = 0, n; x < e->width; x += n) {
        n = rf_edge_run(e, x, y, &rough);
        for (ptrdiff_t i = at + x; i < at + x + n && rough; i++)
            if (rf_is_between(e, i, e->map[i]))
                settle->contrast[i] = (uint16_t)(e->near[i] - e->far[i]);
    }
}

/* Cores are the pixels beyond bands, from which the others take their disparity. */
static void find_cores(void *context, int y, int worker)
{
    const struct settle *settle = context;
    const struct rf_edges *e = settle->e;
    uint16_t *core = settle->core + y * e->stride;

    (void)worker;
    for (int x = 0; x < e->width; x++) {
        const ptrdiff_t at = y * e->stride + x;

        core[x] = settle->contrast[at] ? 0 : (uint16_t)rf_larger(e->map[at], 1);
    }
    for (int x = e->width; x < RF_MOST_VOTE_COLUMNS; x++)
        core[x] = 0;
}

static struct rf_core_sums look(const struct settle *settle, int x, int y)
{
    const struct rf_edges *e = settle->e;
    const ptrdiff_t at = y * e->stride + x;
    const int own = e->label[at], most = settle->contrast[at] / ALIKE;
    const struct rf_vote_place place = rf_place_window(e, &settle->shape, x, y);
    const struct rf_core_window window = {
        .core = settle->core + place.first,
        .stride = e->stride,
        .nearness = place.nearness,
        .nearness_stride = (ptrdiff_t)sizeof settle->shape.nearness[0] * settle->shape.step,
        .columns = settle->shape.columns,
        .rows = place.rows,
        .step = settle->shape.step,
        .least = (uint16_t)rf_larger(own - most, 1),
        .most = (uint16_t)rf_smaller(own + most, 65535),
    };

    return e->kernels->core_sums(&window);
}

static void settle_row(void *context, int y, int worker)
{
    const struct settle *settle = context;
    struct rf_edges *e = settle->e;

    (void)worker;
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
    struct settle settle = {
        .e = e,
        .contrast = e->kept,
        .core = e->largest,
        .shape = rf_vote_shape(softness, 0.35),
    };

    rf_pool_run(e->pool, find_contrast, &settle, e->height);
    rf_widen(e, settle.contrast, e->spare, (int)(0.7 * softness + 1));
    rf_pool_run(e->pool, find_cores, &settle, e->height);
    rf_pool_run(e->pool, settle_row, &settle, e->height);
}
