/* align.c: moves the edges of a disparity map onto the photo's, where they do not lie on them.
 *
 * How well edges lie on the photo is the mean, over them, of the photo's gradient across them. An
 * exact map has about twice as much of it in place as a few pixels beside. So
 *
 *   1. For each block the shift with the most of it is looked for. The map is on the photo where
 *      most blocks want none: nothing is done.
 *   2. Else one shift of the whole map, or one number of pixels by which near surfaces are too
 *      large or too small, is undone if it is clearly better than none.
 *   3. Else each block's edges go where they fit best, and then once more in blocks half as large,
 *      if they fit clearly better there.
 *
 * A worked example: 'grown by 4 pixels' has 0.65 of the median support in place, 2.3 with near
 * surfaces smaller by 4: step 2. A map of a network has 1.2 in place, no shift is better, and 1.6
 * after step 3. An exact map by night, where blocks are unsure, has 1.5 in place: it stays. With
 * the photo of another scene it is 0.96 to 1.03: there is nothing to go by, and it stays too.
 */
#include "edges/edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    REACH = RF_EDGE_SHIFT,
    SHIFTS = 89, /* shifts that are no longer than sqrt(REACH^2 + 1) */
    GROWTHS = 2 * RF_MOST_GROWN + 1,
    FEWEST = 200, /* edges that can tell */
    LARGE_BLOCK = 16,
    SMALL_BLOCK = 8,
    SMALL_REACH = 3,
    MOST_WINDOW = (2 * REACH + 1) * 12, /* shifts of a large block, and some that are not used */
    SMALL_WINDOW = (2 * SMALL_REACH + 1) * 8, /* a small block has these */
    MOST_LOOKED_AT = 1 << 13,                 /* edges; of more every second, third ... */
};
_Static_assert(4 * SMALL_WINDOW >= MOST_WINDOW, "memory for small blocks is enough for large ones");
static const double ON_PHOTO = 0.75;  /* share of edges: the map needs nothing */
static const double FITS = 1.4;       /* support in place: blocks are unsure, not wrong */
static const double UNRELATED = 1.06; /* less support in place: it is the photo of something else */
static const double CLEARLY = 1.15;   /* times better */
static const double SOFTEST = 3.2;    /* pixels: softer edges say little of their place */

struct shift {
    int x, y;
};

/* The edges of a map, summed up block by block and smoothed over neighbouring blocks. */
struct blocks {
    struct rf_edges *e;
    int side, across, down;
    int reach, columns; /* a window of shifts has 2 reach + 1 rows of columns */
    int shifts, every;
    struct shift shift[SHIFTS];
    double length[SHIFTS];
    int32_t *support;      /* for each block, its window of shifts */
    int32_t *count;        /* number of edges, in 1/256 */
    double *right, *below; /* where the edges of a block fit best, pixels */
    double *weight;
    int64_t total[SHIFTS];
};

static int list_shifts(struct shift shift[SHIFTS], int reach)
{
    int n = 0;

    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            if (x * x + y * y <= reach * reach + 1)
                shift[n++] = (struct shift){x, y};
    return n;
}

static double length(struct shift shift)
{
    return sqrt(shift.x * shift.x + shift.y * shift.y);
}

/* The number of values in a window of shifts, and where one lies in it. */
static int window_size(const struct blocks *b)
{
    return (2 * b->reach + 1) * b->columns;
}

static int place_of(const struct blocks *b, int shift)
{
    return (b->shift[shift].y + b->reach) * b->columns + b->shift[shift].x + b->reach;
}

/* Weights 1 4 6 4 1 along n windows of `size` values that lie `step` apart: 16 times a mean. */
static void smooth_line(int32_t *at, int size, int n, ptrdiff_t step)
{
    int32_t last[2][MOST_WINDOW] = {{0}};
    static const int32_t none[MOST_WINDOW];

    for (int k = 0; k < n; k++) {
        int32_t *restrict own = at + k * step;
        const int32_t *restrict next = k + 1 < n ? own + step : none;
        const int32_t *restrict after = k + 2 < n ? own + 2 * step : none;

        for (int i = 0; i < size; i++) {
            const int32_t was = own[i];

            own[i] = last[0][i] + 4 * last[1][i] + 6 * was + 4 * next[i] + after[i];
            last[0][i] = last[1][i];
            last[1][i] = was;
        }
    }
}

struct smoothing {
    const struct blocks *b;
    int32_t *sum;
    int size; /* values of a block */
};

static void smooth_across(void *context, int row, int worker)
{
    const struct smoothing *s = context;

    (void)worker;
    smooth_line(s->sum + (ptrdiff_t)row * s->b->across * s->size, s->size, s->b->across, s->size);
}

static void smooth_down(void *context, int column, int worker)
{
    const struct smoothing *s = context;

    (void)worker;
    smooth_line(s->sum + (ptrdiff_t)column * s->size, s->size, s->b->down,
                (ptrdiff_t)s->b->across * s->size);
}

/* Sums over neighbouring blocks, 256 times a mean. */
static void smooth_blocks(const struct blocks *b, int32_t *sum, int size)
{
    struct smoothing smoothing = {b, sum, size};

    rf_pool_run(b->e->pool, smooth_across, &smoothing, b->down);
    rf_pool_run(b->e->pool, smooth_down, &smoothing, b->across);
}

static ptrdiff_t block_of(const struct blocks *b, const struct rf_map_edge *edge)
{
    return (ptrdiff_t)(edge->y / b->side) * b->across + edge->x / b->side;
}

/* The first edge in row y or below, a multiple of `every`. */
static int first_edge(const struct blocks *b, int y)
{
    int low = 0, high = (b->e->edges + b->every - 1) / b->every;

    while (low < high) {
        const int middle = low + (high - low) / 2;

        if (b->e->edge[middle * b->every].y < y)
            low = middle + 1;
        else
            high = middle;
    }
    return low * b->every;
}

static void add_support(void *context, int row, int worker)
{
    const struct blocks *b = context;
    const struct rf_edges *e = b->e;
    const int size = window_size(b), end = first_edge(b, (row + 1) * b->side);
    const ptrdiff_t first = (ptrdiff_t)row * b->across;

    (void)worker;
    memset(b->support + first * size, 0, (size_t)b->across * (size_t)size * sizeof *b->support);
    memset(b->count + first, 0, (size_t)b->across * sizeof *b->count);
    for (int i = first_edge(b, row * b->side); i < end; i += b->every) {
        const struct rf_map_edge *edge = &e->edge[i];
        const ptrdiff_t at = (edge->y - b->reach) * e->stride + edge->x - b->reach;
        const struct rf_edge_window window = {.gradient_x = e->gradient.x + at,
                                              .gradient_y = e->gradient.y + at,
                                              .stride = e->stride,
                                              .rows = 2 * b->reach + 1,
                                              .columns = b->columns,
                                              .normal_x = edge->normal_x,
                                              .normal_y = edge->normal_y};

        e->kernels->edge_support(b->support + block_of(b, edge) * size, &window);
        b->count[block_of(b, edge)]++;
    }
}

static void sum_support(struct blocks *b)
{
    const int size = window_size(b);

    for (int i = 0; i < b->shifts; i++) {
        const int32_t *support = b->support + place_of(b, i);

        b->total[i] = 0;
        for (ptrdiff_t k = 0; k < (ptrdiff_t)b->across * b->down; k++)
            b->total[i] += support[k * size];
    }
}

/* The one in the middle, by parting around one of those that are left (Hoare's quickselect). */
static int64_t median(const int64_t *value, int n)
{
    int64_t left[SHIFTS + GROWTHS];
    int low = 0, high = n - 1;

    memcpy(left, value, (size_t)n * sizeof *left);
    while (low < high) {
        const int64_t pivot = left[n / 2];
        int i = low, j = high;

        while (i <= j) {
            while (left[i] < pivot)
                i++;
            while (left[j] > pivot)
                j--;
            if (i <= j) {
                const int64_t swap = left[i];

                left[i++] = left[j];
                left[j--] = swap;
            }
        }
        if (j < n / 2)
            low = i;
        if (i > n / 2)
            high = j;
    }
    return left[n / 2];
}

/* The shift that one block wants. */
struct wish {
    struct shift shift;
    double gain; /* in support over that in place, in medians; longer shifts have to gain more */
    double best; /* greatest support, in medians */
};

static struct wish ask_block(const struct blocks *b, ptrdiff_t block)
{
    const int32_t *window = b->support + block * window_size(b);
    /* The median of no edge would be 0: half an edge with a gradient of a code is added. */
    const double count = b->count[block] + 128;
    struct wish wish = {{0, 0}, 0, 0};
    int64_t support[SHIFTS] = {0};
    double middle, zero = 0, most = -1e9;

    for (int i = 0; i < b->shifts; i++)
        support[i] = window[place_of(b, i)];
    middle = (double)median(support, b->shifts) / count + 16;
    for (int i = 0; i < b->shifts; i++) {
        const double times = (double)support[i] / count / middle;
        const double worth = times - 0.02 * b->length[i];

        if (worth > most) {
            most = worth;
            wish.shift = b->shift[i];
        }
        if (b->shift[i].x == 0 && b->shift[i].y == 0)
            zero = worth;
        wish.best = times > wish.best ? times : wish.best;
    }
    wish.gain = most - zero;
    return wish;
}

/* Weights 1 4 6 4 1 over the blocks around, of what those want that know. */
static void smooth_field(const struct blocks *b, double *field)
{
    for (int way = 0; way < 2; way++) {
        const int lines = way ? b->across : b->down, n = way ? b->down : b->across;
        const ptrdiff_t step = way ? b->across : 1, next = way ? 1 : b->across;

        for (int i = 0; i < lines; i++) {
            double *at = field + i * next, before[2] = {0, 0};

            for (int k = 0; k < n; k++) {
                const double own = at[k * step], after = k + 1 < n ? at[(k + 1) * step] : 0;
                const double last = k + 2 < n ? at[(k + 2) * step] : 0;

                at[k * step] = before[0] + 4 * before[1] + 6 * own + 4 * after + last;
                before[0] = before[1];
                before[1] = own;
            }
        }
    }
}

/*
 * Finds where the edges of each block fit best. A shift that gains less than `margin` counts as
 * none. Returns the share of the edges, by how clearly they can tell, whose block wants at most a
 * pixel and a half.
 */
static double ask_blocks(struct blocks *b, double margin)
{
    const ptrdiff_t n = (ptrdiff_t)b->across * b->down;
    double content = 0, all = 0;

    b->every = b->e->edges / MOST_LOOKED_AT + 1;
    rf_pool_run(b->e->pool, add_support, b, b->down);
    sum_support(b);
    smooth_blocks(b, b->count, 1);
    smooth_blocks(b, b->support, window_size(b));
    for (ptrdiff_t i = 0; i < n; i++) {
        const double count = b->count[i] / 256.0;
        struct wish wish;
        double clear, weight;

        b->right[i] = b->below[i] = b->weight[i] = 0;
        if (b->count[i] == 0)
            continue;
        wish = ask_block(b, i);
        clear = count * fmin(fmax(wish.best - 1.3, 0), 1);
        all += clear;
        content += length(wish.shift) <= 1.5 ? clear : 0;
        weight = wish.gain > margin ? count * fmin(wish.gain, 1) : count * 0.2;
        b->weight[i] = weight;
        if (wish.gain > margin) {
            b->right[i] = weight * wish.shift.x;
            b->below[i] = weight * wish.shift.y;
        }
    }
    smooth_field(b, b->right);
    smooth_field(b, b->below);
    smooth_field(b, b->weight);
    for (ptrdiff_t i = 0; i < n; i++)
        if (b->weight[i] > 0) {
            b->right[i] /= b->weight[i];
            b->below[i] /= b->weight[i];
        }
    return all > 0 ? content / all : 1;
}

/* ----- what is common to all edges ----- */

/* The mean support of all edges in place. */
static double support_in_place(const struct rf_edges *e)
{
    const int every = e->edges / MOST_LOOKED_AT + 1;
    int64_t total = 0;
    int n = 0;

    for (int i = 0; i < e->edges; i += every, n++)
        total += rf_photo_edge_at(e, &e->edge[i], e->edge[i].x, e->edge[i].y);
    return n ? (double)total / n : 0;
}

/* The support `along` pixels towards the nearer side of each edge; from -REACH - 1 on. */
static void ask_growths(const struct rf_edges *e, int64_t total[GROWTHS])
{
    const int every = e->edges / MOST_LOOKED_AT + 1;

    for (int k = 0; k < GROWTHS; k++) {
        const int along = k - REACH - 1;

        total[k] = 0;
        for (int i = 0; i < e->edges; i += every) {
            const struct rf_map_edge *edge = &e->edge[i];
            const int x = (along * edge->normal_x + 64) >> 7,
                      y = (along * edge->normal_y + 64) >> 7;

            total[k] += rf_photo_edge_at(e, edge, edge->x + x, edge->y + y);
        }
    }
}

/* One correction of the whole map. */
struct whole {
    struct shift shift;
    double grown;       /* pixels that near surfaces are too large by, a fraction too */
    double worth, zero; /* support with it and without, in medians */
};

/* The peak of a parabola through three values, from the middle one. */
static double peak(double before, double middle, double after)
{
    const double bend = before - 2 * middle + after;

    return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

static struct whole ask_whole(const struct blocks *b)
{
    /* In the photo the silhouette of a near thing lies a little on its far side: it is mixed. */
    static const double FAR_SIDE = 0.2;
    int64_t growth[GROWTHS], all[SHIFTS + GROWTHS];
    struct whole whole = {{0, 0}, 0, -1e9, 0};
    double middle;

    ask_growths(b->e, growth);
    memcpy(all, b->total, (size_t)b->shifts * sizeof *all);
    memcpy(all + b->shifts, growth, sizeof growth);
    middle = (double)median(all, b->shifts + GROWTHS) + 1e-9;
    for (int k = 1; k < GROWTHS - 1; k++) {
        const int along = k - REACH - 1;
        const double worth = (double)growth[k] / middle - 0.03 * abs(along);

        if (worth <= whole.worth)
            continue;
        whole.worth = worth;
        whole.grown =
            along + FAR_SIDE +
            (along ? peak((double)growth[k - 1], (double)growth[k], (double)growth[k + 1]) : 0);
    }
    for (int i = 0; i < b->shifts; i++) {
        const double worth = (double)b->total[i] / middle - 0.03 * b->length[i];

        if (b->shift[i].x == 0 && b->shift[i].y == 0)
            whole.zero = worth;
        if (worth > whole.worth) {
            whole.worth = worth;
            whole.shift = b->shift[i];
            whole.grown = 0;
        }
    }
    return whole;
}

/* ----- corrections ----- */

struct change {
    struct rf_edges *e;
    const struct blocks *blocks; /* or NULL */
    struct shift shift;
};

/* A field between the middles of blocks. */
static double between(const struct blocks *b, const double *field, int x, int y)
{
    const double fx = fmin(fmax((x + 0.5) / b->side - 0.5, 0), b->across - 1);
    const double fy = fmin(fmax((y + 0.5) / b->side - 0.5, 0), b->down - 1);
    const int u = rf_smaller((int)fx, rf_larger(b->across - 2, 0));
    const int v = rf_smaller((int)fy, rf_larger(b->down - 2, 0));
    const double *at = field + (ptrdiff_t)v * b->across + u;
    const ptrdiff_t right = b->across > 1, below = b->down > 1 ? b->across : 0;

    return (at[0] * (1 - (fx - u)) + at[right] * (fx - u)) * (1 - (fy - v)) +
           (at[below] * (1 - (fx - u)) + at[below + right] * (fx - u)) * (fy - v);
}

static void move_band(void *context, int band, int worker)
{
    const struct change *change = context;
    const struct blocks *b = change->blocks;
    const struct rf_edges *e = change->e;
    const int end = rf_smaller((band + 1) * RF_EDGE_BAND, e->height);

    (void)worker;
    for (int y = band * RF_EDGE_BAND; y < end; y++)
        for (int x = 0; x < e->width; x++) {
            int u = x - change->shift.x, v = y - change->shift.y;

            if (b) {
                u = (int)floor(x - between(b, b->right, x, y) + 0.5);
                v = (int)floor(y - between(b, b->below, x, y) + 0.5);
            }
            e->spare[y * e->stride + x] =
                e->map[rf_smaller(rf_larger(v, 0), e->height - 1) * e->stride +
                       rf_smaller(rf_larger(u, 0), e->width - 1)];
        }
}

static void move(struct rf_edges *e, const struct blocks *blocks, struct shift shift)
{
    struct change change = {.e = e, .blocks = blocks, .shift = shift};

    rf_pool_run(e->pool, move_band, &change, rf_edge_bands(e));
    rf_copy_plane(e, e->map, e->spare);
}

/* Ramps of the map as it is now. */
static void find_ramps(struct rf_edges *e, const struct rf_ramp_limits *limits)
{
    if (!limits) {
        rf_find_rough_blocks(e, e->map);
        return;
    }
    rf_find_steepest(e);
    rf_find_ramps(e, *limits);
}

/* Ramps and edges of the map as it is now. */
static void look_again(struct rf_edges *e, const struct rf_ramp_limits *limits)
{
    find_ramps(e, limits);
    rf_find_map_edges(e, limits ? e->label : e->map);
}

/* Makes near surfaces smaller or larger by the whole number of pixels that fits best. */
static int undo_growth(struct rf_edges *e, double grown, const struct rf_ramp_limits *limits)
{
    const int sign = grown < 0 ? -1 : 1, least = rf_smaller((int)fabs(grown), RF_MOST_GROWN - 1);
    double support[2];

    rf_copy_plane(e, e->kept, e->map);
    for (int i = 0; i < 2; i++) {
        rf_copy_plane(e, e->map, e->kept);
        rf_regrow(e, sign * (least + i));
        look_again(e, limits);
        support[i] = support_in_place(e);
    }
    if (support[1] > support[0])
        return sign * (least + 1);
    rf_copy_plane(e, e->map, e->kept);
    rf_regrow(e, sign * least);
    look_again(e, limits);
    return sign * least;
}

static struct blocks blocks_of(struct rf_edges *e, int side, int reach)
{
    struct blocks b = {
        .e = e,
        .side = side,
        .across = (e->width + side - 1) / side,
        .down = (e->height + side - 1) / side,
        .reach = reach,
        .columns = reach == REACH ? 12 : 8,
        .support = e->blocks.support,
        .count = e->blocks.count,
        .right = e->blocks.right,
        .below = e->blocks.below,
        .weight = e->blocks.weight,
    };

    b.shifts = list_shifts(b.shift, reach);
    for (int i = 0; i < b.shifts; i++)
        b.length[i] = length(b.shift[i]);
    return b;
}

/* Moves edges block by block; false, and the map is as it was, if they do not fit clearly better.
 */
static bool bend(struct rf_edges *e, const struct blocks *large,
                 const struct rf_ramp_limits *limits)
{
    const double before = support_in_place(e);
    struct blocks small = blocks_of(e, SMALL_BLOCK, SMALL_REACH);

    rf_copy_plane(e, e->kept, e->map);
    move(e, large, (struct shift){0, 0});
    look_again(e, limits);
    ask_blocks(&small, 0.05);
    move(e, &small, (struct shift){0, 0});
    look_again(e, limits);
    if (support_in_place(e) > CLEARLY * before)
        return true;
    rf_copy_plane(e, e->map, e->kept);
    find_ramps(e, limits);
    return false;
}

struct rf_alignment rf_align(struct rf_edges *e, double softness,
                             const struct rf_ramp_limits *limits)
{
    struct rf_alignment found = {.on_photo = 1};
    struct blocks large = blocks_of(e, LARGE_BLOCK, REACH);
    struct whole whole;
    bool is_related;

    rf_find_map_edges(e, limits ? e->label : e->map);
    if (e->edges < FEWEST || rf_run_cancelled(e->pool->run))
        return found;
    rf_find_photo_gradient(e);
    found.on_photo = ask_blocks(&large, 0.1);
    if (found.on_photo >= ON_PHOTO || rf_run_cancelled(e->pool->run))
        return found;
    whole = ask_whole(&large);
    if (whole.worth > CLEARLY * whole.zero) {
        if (fabs(whole.grown) >= 1.5 && (softness == 0 || fabs(whole.grown) > softness))
            found.grown = undo_growth(e, whole.grown, limits);
        else if (length(whole.shift) >= 2) {
            found.shift_x = whole.shift.x;
            found.shift_y = whole.shift.y;
            move(e, NULL, whole.shift);
            look_again(e, limits);
        }
        found.on_photo = ask_blocks(&large, 0.1);
    }
    is_related = whole.zero > UNRELATED || found.grown || found.shift_x || found.shift_y;
    if (found.on_photo < ON_PHOTO && softness < SOFTEST && whole.zero < FITS && is_related)
        found.bent = bend(e, &large, limits);
    return found;
}

/* The bytes that blocks of each size need. */
void rf_align_lay_out(struct rf_edges *e, struct rf_arena *arena)
{
    const uint64_t large = (uint64_t)((e->width + LARGE_BLOCK - 1) / LARGE_BLOCK) *
                           (uint64_t)((e->height + LARGE_BLOCK - 1) / LARGE_BLOCK);
    const uint64_t small = 4 * large;

    e->blocks.support = rf_arena_take(arena, small * SMALL_WINDOW, sizeof *e->blocks.support);
    e->blocks.count = rf_arena_take(arena, small, sizeof *e->blocks.count);
    e->blocks.right = rf_arena_take(arena, small, sizeof *e->blocks.right);
    e->blocks.below = rf_arena_take(arena, small, sizeof *e->blocks.below);
    e->blocks.weight = rf_arena_take(arena, small, sizeof *e->blocks.weight);
}
