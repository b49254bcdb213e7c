/* ramps.c: follows the ramps of a soft disparity map to the surfaces at their ends. */
#include "edges/edges.h"

#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    FLAT = 79,               /* 0.0012: a smaller step belongs to the surface */
    CLEAR = 6554,            /* 0.1: contrasts that softness is measured by */
    LEAST_STEP = CLEAR / 20, /* pixels of less hardly count */
    BINS = 256,              /* contrast / largest step, in 1/16 pixels */
    MOST_STEPS = 16,         /* a longer ramp is a slope, when softness is measured */
    ROWS = 64,               /* softness is measured on so many, at least */
    WAVES = 16,              /* contrast / what a flat surface differs by */
    BEYOND = 3,              /* pixels: a step to the end of a ramp, and two beyond */
    FEWEST = 50,             /* pixels along edges to measure softness by */
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
    const int y = row * RF_EDGE_BLOCK;

    (void)worker;
    e->kernels->block_ranges(e->range + (ptrdiff_t)row * rf_edge_blocks_across(e),
                             ranges->plane + y * e->stride, e->stride, e->width,
                             rf_smaller(RF_EDGE_BLOCK, e->height - y));
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

static void find_steepest(void *context, int y, int worker)
{
    const struct rf_edges *e = context;
    const uint16_t *here = e->map + y * e->stride;
    const uint16_t *const row[3] = {here - e->stride, here, here + e->stride};

    (void)worker;
    e->kernels->steepest(e->steepest + y * e->stride, row, e->width);
}

/* Ways up or down from all pixels of rough cells, a step at a time. */
struct climb {
    const struct rf_edges *e;
    bool down;
    uint16_t *end;
    const uint16_t *from;
    uint16_t *to;
    int step, steps;
    const uint8_t *moved; /* one for each cell: whether ways from there went on by the last step */
    uint8_t *moves;       /* 1: ways go on by this step */
};

static int cells_across(const struct rf_edges *e)
{
    return (e->width + RF_CLIMB_CELL - 1) / RF_CLIMB_CELL;
}

static int cells_down(const struct rf_edges *e)
{
    return (e->height + RF_CLIMB_CELL - 1) / RF_CLIMB_CELL;
}

/* Whether a way from a cell so near that it comes this far still goes on. */
static bool is_needed(const struct climb *climb, int column, int row)
{
    const int across = cells_across(climb->e), down = cells_down(climb->e);
    const int cells = (climb->steps + RF_CLIMB_CELL - 1) / RF_CLIMB_CELL;
    const int right = rf_smaller(column + cells, across - 1);

    for (int v = rf_larger(row - cells, 0); v <= rf_smaller(row + cells, down - 1); v++)
        for (int u = rf_larger(column - cells, 0); u <= right; u++)
            if (climb->moved[v * across + u])
                return true;
    return false;
}

static void climb_cells(void *context, int row, int worker)
{
    const struct climb *climb = context;
    const struct rf_edges *e = climb->e;
    const int across = cells_across(e), y = row * RF_CLIMB_CELL;

    (void)worker;
    for (int column = 0; column < across; column++) {
        const int x = column * RF_CLIMB_CELL;
        const ptrdiff_t at = y * e->stride + x;
        const struct rf_climb_cell cell = {
            .direction = e->steepest + at,
            .down = climb->down,
            .from = climb->from + at,
            .to = climb->to + at,
            .end = climb->end + at,
            .largest = e->largest + at,
            .length = e->length + at,
            .stride = e->stride,
            .columns = rf_smaller(RF_CLIMB_CELL, e->width - x),
            .rows = rf_smaller(RF_CLIMB_CELL, e->height - y),
            .flat = FLAT,
            .step = (uint16_t)climb->step,
        };

        bool goes = false;

        if (is_needed(climb, column, row))
            goes = e->kernels->climb(&cell);
        /* Other cells are only there for the ways that lead through them. */
        climb->moves[row * across + column] = e->rough_cell[row * across + column] ? goes : 0;
    }
}

/* Ways of pixels whose length is `kept` are not gone. */
static void climb(struct rf_edges *e, bool down, uint16_t *end, int steps, int kept)
{
    const int cells = cells_across(e) * cells_down(e);
    struct climb climb = {
        .e = e, .down = down, .end = end, .from = e->map, .steps = steps, .moved = e->rough_cell};

    rf_copy_plane(e, end, e->map);
    for (int y = 0; y < e->height; y++)
        for (int x = 0; x < e->width; x++) {
            uint16_t *length = &e->length[y * e->stride + x];

            *length = *length == kept ? kept : 0;
        }
    for (climb.step = 1; climb.step <= steps; climb.step++) {
        climb.to = climb.step % 2 ? e->spare : e->label;
        climb.moves = e->moved[climb.step % 2];
        rf_pool_run(e->pool, climb_cells, &climb, cells_down(e));
        if (!memchr(climb.moves, 1, (size_t)cells))
            break;
        climb.from = climb.to;
        climb.moved = climb.moves;
    }
}

static void find_rough_cells(struct rf_edges *e)
{
    for (int y = 0; y < e->height; y += RF_CLIMB_CELL)
        for (int x = 0; x < e->width; x += RF_CLIMB_CELL) {
            const int right = rf_smaller(x + RF_EDGE_BLOCK, e->width - 1);
            const int below = rf_smaller(y + RF_EDGE_BLOCK, e->height - 1);

            e->rough_cell[y / RF_CLIMB_CELL * cells_across(e) + x / RF_CLIMB_CELL] =
                rf_edge_is_rough(e, x, y) || rf_edge_is_rough(e, right, y) ||
                rf_edge_is_rough(e, x, below) || rf_edge_is_rough(e, right, below);
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

void rf_find_steepest(struct rf_edges *e)
{
    repeat_sides(e);
    rf_find_rough_blocks(e, e->map);
    rf_pool_run(e->pool, find_steepest, e, e->height);
}

/* Each way is gone twice, as the first time the ramp's largest step is not known yet. */
static void follow_ramps(struct rf_edges *e, int steps)
{
    const size_t bytes = (size_t)e->stride * (size_t)e->height * sizeof *e->largest;

    find_rough_cells(e);
    memset(e->largest, 0, bytes);
    memset(e->length, 0, bytes);
    climb(e, false, e->near, steps, 0);
    climb(e, true, e->far, steps, 0);
    climb(e, false, e->near, steps, 0);
    climb(e, true, e->far, steps, steps);
}

struct choice {
    const struct rf_edges *e;
    struct rf_ramp_limits limits;
};

/* Some pixels of a row that are looked at together. */
static void choose(const struct choice *choice, ptrdiff_t at, int n)
{
    const struct rf_edges *e = choice->e;
    const struct rf_ramp_limits limits = choice->limits;
    uint16_t *near = e->near + at, *far = e->far + at, *label = e->label + at;

    for (int x = 0; x < n; x++) {
        const uint16_t own = e->map[at + x];
        const bool is_ramp =
            near[x] - far[x] >= limits.contrast && e->length[at + x] < limits.steps;

        near[x] = is_ramp ? near[x] : own;
        far[x] = is_ramp ? far[x] : own;
        label[x] = 2 * own > near[x] + far[x] ? near[x] : far[x];
    }
}

static void choose_row(void *context, int y, int worker)
{
    const struct choice *choice = context;
    const struct rf_edges *e = choice->e;

    (void)worker;
    for (int x = 0; x < e->width; x += RF_EDGE_BLOCK) {
        const ptrdiff_t at = y * e->stride + x;
        const int n = rf_smaller(RF_EDGE_BLOCK, e->width - x);
        uint16_t *const out[3] = {e->near + at, e->far + at, e->label + at};

        if (rf_edge_is_rough(e, x, y))
            choose(choice, at, n);
        for (int i = 0; i < 3 && !rf_edge_is_rough(e, x, y); i++)
            memcpy(out[i], e->map + at, (size_t)n * sizeof *e->map);
    }
}

void rf_find_ramps(struct rf_edges *e, struct rf_ramp_limits limits)
{
    struct choice choice = {e, limits};

    follow_ramps(e, limits.steps);
    rf_pool_run(e->pool, choose_row, &choice, e->height);
}

/* ----- softness ----- */

/* A way up or down from a pixel. */
struct way {
    ptrdiff_t at;
    int steps, largest;
};

static struct way go(const struct rf_edges *e, ptrdiff_t i, bool down, int largest)
{
    const ptrdiff_t s = e->stride;
    const ptrdiff_t neighbour[RF_NO_DIRECTION] = {1, -1, s, -s, s + 1, 1 - s, s - 1, -1 - s};
    struct way way = {i, 0, largest};

    for (; way.steps < MOST_STEPS; way.steps++) {
        const int direction = e->steepest[way.at] >> (down ? 4 : 0) & 15;
        int step;

        if (direction == RF_NO_DIRECTION)
            break;
        step = abs(e->map[way.at + neighbour[direction]] - e->map[way.at]);
        if (step < FLAT || step * RF_RAMP_ENDS < way.largest)
            break;
        way.at += neighbour[direction];
        way.largest = rf_larger(way.largest, step);
    }
    return way;
}

/* The largest difference of a pixel to the four beside, above and below it. */
static int local_step(const struct rf_edges *e, ptrdiff_t i)
{
    const int own = e->map[i];
    const int across = rf_larger(abs(own - e->map[i - 1]), abs(own - e->map[i + 1]));
    const int down = rf_larger(abs(own - e->map[i - e->stride]), abs(own - e->map[i + e->stride]));

    return rf_larger(across, down);
}

/* How soft the ramps of some pixels are: contrast / largest step, in 1/16 pixels. Each counts by
 * its own share of the ramp, so that wide ramps do not count more than narrow ones. */
struct histogram {
    int64_t bin[BINS], all;
    int64_t narrow, mixed; /* between flat surfaces: all ramps of up to two steps; their middles */
};

/* Whether the surface at the end of a ramp stays as it is for two pixels beyond. */
static bool is_flat(const struct rf_edges *e, ptrdiff_t end, ptrdiff_t onward, int most)
{
    const uint16_t *map = e->map + end;

    return abs(map[onward] - map[0]) < most && abs(map[2 * onward] - map[0]) < most;
}

/* Counts a pixel of a ramp of one step or two, between surfaces that are flat beside its contrast:
 * where compression left waves it is not known what a sample between two others is. */
static void add_narrow(const struct rf_edges *e, ptrdiff_t at, ptrdiff_t near, ptrdiff_t far,
                       int share, struct histogram *ramps)
{
    const int contrast = e->map[near] - e->map[far], most = contrast / WAVES;
    const ptrdiff_t up = near != at ? near - at : at - far;
    const ptrdiff_t down = far != at ? far - at : at - near;
    const int x = (int)(at % e->stride), y = (int)(at / e->stride);

    if (x < BEYOND || y < BEYOND || x >= e->width - BEYOND || y >= e->height - BEYOND)
        return;
    if (!is_flat(e, near, up, most) || !is_flat(e, far, down, most))
        return;
    ramps->narrow += share;
    if (near != at && far != at && rf_is_mixed(e->map[near], e->map[far], e->map[at]))
        ramps->mixed += share;
}

static void add_ramp(const struct rf_edges *e, ptrdiff_t at, struct histogram *ramps)
{
    const int first = go(e, at, true, go(e, at, false, 0).largest).largest;
    const struct way near = go(e, at, false, first), far = go(e, at, true, first);
    const int contrast = e->map[near.at] - e->map[far.at];
    int share;

    if (contrast < CLEAR || near.steps == MOST_STEPS || far.steps == MOST_STEPS)
        return;
    share = 256 * local_step(e, at) / contrast;
    ramps->bin[rf_smaller(16 * contrast / first, BINS - 1)] += share;
    ramps->all += share;
    if (near.steps <= 1 && far.steps <= 1)
        add_narrow(e, at, near.at, far.at, share, ramps);
}

/* The ramps of some rows; all = 0: there are too few to tell. */
static struct histogram measure_ramps(const struct rf_edges *e)
{
    const int every = e->height / ROWS + 1;
    struct histogram ramps = {.all = 0};

    if (rf_run_cancelled(e->pool->run)) /* the plane of directions is not complete */
        return ramps;
    for (int y = every / 2; y < e->height; y += every)
        for (int x = 0; x < e->width; x++) {
            const ptrdiff_t at = y * e->stride + x;

            if (rf_edge_is_rough(e, x, y) && local_step(e, at) >= LEAST_STEP)
                add_ramp(e, at, &ramps);
        }
    ramps.all *= ramps.all * every >= FEWEST * 256;
    ramps.narrow *= ramps.narrow * every >= FEWEST * 256;
    return ramps;
}

/*
 * A sharp edge of contrast c, blurred by a Gaussian of standard deviation s, is steepest in its
 * middle, c / (s sqrt(2 pi)) a pixel: so s = contrast / largest step / 2.507. The two pixels at a
 * step of an exact map read 1 / 2.507 = 0.4.
 */
double rf_measure_softness(const struct rf_edges *e, int percentile)
{
    const struct histogram ramps = measure_ramps(e);
    int64_t below = 0;
    int i = 0;

    if (ramps.all == 0)
        return 0;
    while (i < BINS - 1 && (below += ramps.bin[i]) * 100 < ramps.all * percentile)
        i++;
    return (i + 0.5) / (16 * 2.5066);
}

double rf_share_mixed(const struct rf_edges *e)
{
    const struct histogram ramps = measure_ramps(e);

    return ramps.narrow ? (double)ramps.mixed / (double)ramps.narrow : 0;
}
