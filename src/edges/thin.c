/* thin.c: gives wires, stems and hair back the disparity that the softness of a map took.
 *
 * In a soft map the peak of a thin surface is a mixture of it and of what is behind. With G the
 * Gaussian of the map's softness, S the pixels of the thin surface and o the disparities of the
 * others, the map is at pixel q
 *
 *     m(q) = v B(q) + O(q),    B(q) = sum of G over S,    O(q) = sum of G o over the others
 *
 * and the v that fits best over the pixels of S around p is
 *
 *     v = sum B (m - O) / sum B^2
 *
 * A wire of 2 pixels in a map of softness 2: B = 0.38 in its middle. With the wire at 0.9 and 0.1
 * behind it the map's peak is 0.38 0.9 + 0.62 0.1 = 0.40; v = (0.40 - 0.062) / 0.38 = 0.9.
 */
#include "edges/window.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WHOLE = 65536,
    MOST_OWN = WHOLE * 85 / 100, /* a surface that has this much of the window is not thin */
    CRUMB = 8,     /* so much closer to one surface than to another is no surface of its own */
    LEAST_OWN = 2, /* percent: too little is seen of a surface whose mean of B^2 is less */
};

struct thin {
    struct rf_edges *e;
    uint16_t *own;   /* B, Q16 */
    uint16_t *other; /* O */
    uint16_t *is_looked_at;
    int reach, near_by, columns;
    /* The Gaussian in Q16, of sum 1 at most, and 0 beyond the reach. */
    uint16_t gauss[2 * RF_VOTE_REACH + 1][2 * RF_VOTE_MIDDLE + 1];
};

/* Rounded down: the sum of all may not exceed 1. */
static void make_gauss(struct thin *thin, double softness)
{
    const int reach = thin->reach;
    double line[2 * RF_VOTE_REACH + 1], sum = 0;

    for (int i = 0; i <= 2 * reach; i++) {
        const double off = (i - reach) / softness;

        line[i] = rf_exp_minus(off * off / 2);
        sum += line[i];
    }
    for (int y = 0; y <= 2 * reach; y++)
        for (int x = 0; x <= 2 * reach; x++)
            thin->gauss[RF_VOTE_REACH - reach + y][RF_VOTE_MIDDLE - reach + x] =
                (uint16_t)(WHOLE * line[y] * line[x] / (sum * sum));
}

/* Shares are those of what lies within the map. */
static void part_window(const struct thin *thin, int x, int y)
{
    const struct rf_edges *e = thin->e;
    const ptrdiff_t at = y * e->stride + x;
    const int above = rf_smaller(thin->reach, y);
    const int below = rf_smaller(thin->reach, e->height - 1 - y);
    const int last = rf_larger(e->width - thin->columns, 0);
    const int left = rf_smaller(rf_larger(x - thin->reach, 0), last);
    const struct rf_surface_window window = {
        .label = e->label + (y - above) * e->stride + left,
        .stride = e->stride,
        .weight = &thin->gauss[RF_VOTE_REACH - above][RF_VOTE_MIDDLE - (x - left)],
        .weight_stride = sizeof thin->gauss[0] / sizeof thin->gauss[0][0],
        .columns = thin->columns,
        .rows = above + 1 + below,
        .surface = e->label[at],
        .most = RF_EDGE_STEP,
    };
    const struct rf_surface_sums sums = e->kernels->surface_sums(&window);

    thin->own[at] = (uint16_t)rf_smaller((int)((uint64_t)sums.own * WHOLE / sums.all), WHOLE - 1);
    thin->other[at] = (uint16_t)((uint64_t)sums.other / sums.all);
}

static void part_row(void *context, int y, int worker)
{
    const struct thin *thin = context;
    const struct rf_edges *e = thin->e;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        if (thin->is_looked_at[y * e->stride + x])
            part_window(thin, x, y);
}

/* Marks what is looked at to explain pixels of thin surfaces. */
static void mark_thin(void *context, int y, int worker)
{
    const struct thin *thin = context;
    const struct rf_edges *e = thin->e;

    (void)worker;
    for (int x = 0; x < e->width; x++)
        thin->is_looked_at[y * e->stride + x] = !e->is_wide[y * e->stride + x];
}

/* Wide surfaces around a pixel, by how much they differ from it. */
struct wide {
    int least, most; /* INT32_MAX and 0: there is none */
    uint16_t closest;
};

static void note_wide(struct wide *wide, int label, int surface)
{
    const int off = abs(label - surface);

    if (off < wide->least) {
        wide->least = off;
        wide->closest = (uint16_t)label;
    }
    wide->most = rf_larger(wide->most, off);
}

/* The disparity that explains the map best, or the label where the surface is wide. What is much
 * closer to one wide surface around than to another is a crumb of that, left by overshoot, which
 * would be explained by a disparity far beyond both. */
static uint16_t explain(const struct thin *thin, int x, int y)
{
    const struct rf_edges *e = thin->e;
    const int surface = e->label[y * e->stride + x], reach = thin->near_by;
    const int y1 = rf_smaller(y + reach, e->height - 1), x0 = rf_larger(x - reach, 0);
    const int x1 = rf_smaller(x + reach, e->width - 1);
    int64_t product = 0, square = 0, value;
    struct wide wide = {.least = INT32_MAX};
    int pixels = 0;

    for (int v = rf_larger(y - reach, 0); v <= y1; v++)
        for (int u = x0; u <= x1; u++) {
            const ptrdiff_t at = v * e->stride + u;
            const int64_t own = thin->own[at];

            if (abs(e->label[at] - surface) >= RF_EDGE_STEP) {
                if (e->is_wide[at])
                    note_wide(&wide, e->label[at], surface);
                continue;
            }
            if (own > MOST_OWN)
                return (uint16_t)surface;
            product += own * (e->map[at] - thin->other[at]);
            square += own * own;
            pixels++;
        }
    if (wide.least < wide.most / CRUMB)
        return wide.closest;
    if ((square >> 16) * 100 <= (int64_t)WHOLE * LEAST_OWN * pixels)
        return (uint16_t)surface;
    value = product * WHOLE / square;
    return (uint16_t)(value < 0 ? 0 : value < WHOLE ? value : WHOLE - 1);
}

static void explain_row(void *context, int y, int worker)
{
    const struct thin *thin = context;
    const struct rf_edges *e = thin->e;
    const ptrdiff_t at = y * e->stride;

    (void)worker;
    memcpy(e->spare + at, e->label + at, (size_t)e->width * sizeof *e->label);
    for (int x = 0; x < e->width; x++)
        if (!e->is_wide[at + x])
            e->spare[at + x] = explain(thin, x, y);
}

void rf_restore_thin(struct rf_edges *e, double softness)
{
    const double spread = 1.15 * softness; /* with what the decision of pixels adds */
    struct thin thin = {.e = e, .own = e->near, .other = e->far, .is_looked_at = e->kept};

    if (e->width < RF_MOST_VOTE_COLUMNS) /* windows do not fit */
        return;
    thin.reach = rf_smaller((int)ceil(2.2 * spread), RF_VOTE_REACH);
    thin.columns = 2 * thin.reach < RF_VOTE_COLUMNS ? RF_VOTE_COLUMNS : RF_MOST_VOTE_COLUMNS;
    thin.near_by = rf_larger(thin.reach, 3);
    make_gauss(&thin, spread);
    rf_pool_run(e->pool, mark_thin, &thin, e->height);
    rf_widen(e, thin.is_looked_at, e->spare, thin.near_by);
    rf_pool_run(e->pool, part_row, &thin, e->height);
    rf_pool_run(e->pool, explain_row, &thin, e->height);
    rf_copy_plane(e, e->label, e->spare);
}
