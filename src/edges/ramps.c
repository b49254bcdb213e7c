/* ramps.c: follows the ramps of a soft disparity map to the surfaces at their ends. */
#include "edges/edges.h"

#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    FLAT = 79,       /* 0.0012: a smaller step belongs to the surface */
    ENDS = 12,       /* so does one of less than a twelfth of the ramp's largest step */
    CLEAR = 6554,    /* 0.1: contrasts that softness is measured by */
    BINS = 256,      /* contrast / largest step, in 1/16 pixels */
    FEWEST = 50,     /* pixels along edges to measure softness by */
    PERCENTILE = 85, /* wires and hair look less soft than the map is: their two ramps overlap */
};

/* ----- blocks ----- */

struct ranges {
    const struct rf_edges *e;
    const uint16_t *plane;
};

static void find_ranges(void *context, int row, int worker)
{
    const struct ranges *ranges = context;
    const struct rf_edges *e = ranges->e;
    const int across = rf_edge_blocks_across(e);
    const int end = rf_smaller((row + 1) * RF_EDGE_BLOCK, e->height);

    (void)worker;
    for (int b = 0; b < across; b++) {
        const int x0 = b * RF_EDGE_BLOCK, x1 = rf_smaller(x0 + RF_EDGE_BLOCK, e->width);
        struct rf_edge_range range = {65535, 0};

        for (int y = row * RF_EDGE_BLOCK; y < end; y++)
            for (int x = x0; x < x1; x++) {
                const uint16_t d = ranges->plane[y * e->stride + x];

                range.least = d < range.least ? d : range.least;
                range.most = d > range.most ? d : range.most;
            }
        e->range[row * across + b] = range;
    }
}

void rf_find_rough_blocks(struct rf_edges *e, const uint16_t *plane)
{
    const int across = rf_edge_blocks_across(e);
    const int down = (e->height + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK;
    struct ranges ranges = {e, plane};

    rf_pool_run(e->pool, find_ranges, &ranges, down);
    for (int y = 0; y < down; y++)
        for (int x = 0; x < across; x++) {
            int least = 65535, most = 0;

            for (int v = rf_larger(y - 1, 0); v <= rf_smaller(y + 1, down - 1); v++)
                for (int u = rf_larger(x - 1, 0); u <= rf_smaller(x + 1, across - 1); u++) {
                    least = rf_smaller(least, e->range[v * across + u].least);
                    most = rf_larger(most, e->range[v * across + u].most);
                }
            e->rough[y * across + x] = most - least > RF_EDGE_STEP;
        }
}

/* ----- ramps ----- */

struct ramps {
    struct rf_edges *e;
    struct rf_ramp_limits limits;
    ptrdiff_t neighbour[RF_NO_DIRECTION];
};

static void find_steepest(void *context, int band, int worker)
{
    const struct ramps *ramps = context;
    const struct rf_edges *e = ramps->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const uint16_t *here = e->map + y * e->stride;
        const uint16_t *const row[3] = {here - e->stride, here, here + e->stride};

        e->kernels->steepest(e->steepest + y * e->stride, row, e->width);
    }
}

/* One end of a ramp, and the steps that were taken to it. */
struct end {
    int disparity, steps;
};

/* Goes uphill (shift 0) or downhill (shift 4) from pixel i as long as the map keeps rising or
 * falling. *largest is the largest step of the ramp so far. */
static struct end climb(const struct ramps *ramps, ptrdiff_t i, int shift, int *largest)
{
    const struct rf_edges *e = ramps->e;
    struct end end = {e->map[i], 0};

    for (; end.steps < ramps->limits.steps; end.steps++) {
        const int direction = e->steepest[i] >> shift & 15;
        int next, step;

        if (direction == RF_NO_DIRECTION)
            break;
        i += ramps->neighbour[direction];
        next = e->map[i];
        step = abs(next - end.disparity);
        if (step < FLAT || step * ENDS < *largest)
            break;
        *largest = rf_larger(*largest, step);
        end.disparity = next;
    }
    return end;
}

/* Each way is gone twice, as the first time the ramp's largest step is not known yet. */
static void follow_ramp(const struct ramps *ramps, ptrdiff_t i)
{
    struct rf_edges *e = ramps->e;
    const int steps = ramps->limits.steps, own = e->map[i];
    struct end near, far;
    int largest = 0;

    climb(ramps, i, 0, &largest);
    climb(ramps, i, 4, &largest);
    near = climb(ramps, i, 0, &largest);
    far = climb(ramps, i, 4, &largest);
    if (near.disparity - far.disparity < ramps->limits.contrast || near.steps == steps ||
        far.steps == steps)
        return;
    e->near[i] = (uint16_t)near.disparity;
    e->far[i] = (uint16_t)far.disparity;
    e->largest[i] = (uint16_t)largest;
    if (ramps->limits.part)
        e->label[i] = 2 * own > near.disparity + far.disparity ? e->near[i] : e->far[i];
}

static void follow_ramps(void *context, int band, int worker)
{
    const struct ramps *ramps = context;
    struct rf_edges *e = ramps->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);
    const size_t bytes = (size_t)e->width * sizeof *e->map;

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++) {
        const ptrdiff_t at = y * e->stride;

        memcpy(e->near + at, e->map + at, bytes);
        memcpy(e->far + at, e->map + at, bytes);
        memcpy(e->label + at, e->map + at, bytes);
        for (int x = 0; x < e->width; x++)
            if (rf_edge_is_rough(e, x, y))
                follow_ramp(ramps, at + x);
    }
}

/* A pixel of the border is never steeper than the one that it repeats, which comes first. */
static void repeat_sides(struct rf_edges *e)
{
    const size_t bytes = (size_t)(e->width + 2) * sizeof *e->map;

    for (int y = 0; y < e->height; y++) {
        uint16_t *row = e->map + y * e->stride;

        row[-1] = row[0];
        row[e->width] = row[e->width - 1];
    }
    memcpy(e->map - e->stride - 1, e->map - 1, bytes);
    memcpy(e->map + e->height * e->stride - 1, e->map + (e->height - 1) * e->stride - 1, bytes);
}

void rf_find_ramps(struct rf_edges *e, struct rf_ramp_limits limits)
{
    const ptrdiff_t s = e->stride;
    struct ramps ramps = {e, limits, {1, -1, s, -s, s + 1, 1 - s, s - 1, -1 - s}};

    repeat_sides(e);
    rf_find_rough_blocks(e, e->map);
    rf_pool_run(e->pool, find_steepest, &ramps, rf_edge_bands(e));
    rf_pool_run(e->pool, follow_ramps, &ramps, rf_edge_bands(e));
}

/* ----- softness ----- */

/* The largest difference of a pixel to the four beside, above and below it. */
static int local_step(const struct rf_edges *e, ptrdiff_t i)
{
    const int own = e->map[i];
    const int across = rf_larger(abs(own - e->map[i - 1]), abs(own - e->map[i + 1]));
    const int down = rf_larger(abs(own - e->map[i - e->stride]), abs(own - e->map[i + e->stride]));

    return rf_larger(across, down);
}

/*
 * A sharp edge of contrast c, blurred by a Gaussian of standard deviation s, is steepest in its
 * middle, c / (s sqrt(2 pi)) a pixel: so s = contrast / largest step / 2.507. Each pixel of a ramp
 * counts by its own share of the ramp, so that wide ramps do not count more than narrow ones. The
 * two pixels at a step of an exact map read 1 / 2.507 = 0.4.
 */
double rf_measure_softness(const struct rf_edges *e)
{
    int64_t bin[BINS] = {0}, all = 0, below = 0;
    int i = 0;

    for (int y = 0; y < e->height; y++)
        for (int x = 0; x < e->width; x++) {
            const ptrdiff_t at = y * e->stride + x;
            const int contrast = e->near[at] - e->far[at];
            int share;

            if (contrast < CLEAR)
                continue;
            share = 256 * local_step(e, at) / contrast;
            bin[rf_smaller(16 * contrast / rf_larger(e->largest[at], 1), BINS - 1)] += share;
            all += share;
        }
    if (all < FEWEST * 256)
        return 0;
    while (i < BINS - 1 && (below += bin[i]) * 100 < all * PERCENTILE)
        i++;
    return (i + 0.5) / (16 * 2.5066);
}
