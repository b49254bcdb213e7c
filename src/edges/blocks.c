/* blocks.c: sums over the edges in blocks of a disparity map, and which shift each block wants. */
#include "edges/blocks.h"

#include <math.h>
#include <string.h>

#include "support/compare.h"

enum {
    REACH = RF_EDGE_SHIFT,
    MOST_WINDOW = (2 * REACH + 1) * 12, /* shifts of a large block, and some that are not used */
    SMALL_WINDOW = (2 * RF_SMALL_REACH + 1) * 8, /* a small block has these */
};
_Static_assert(4 * SMALL_WINDOW >= MOST_WINDOW, "memory for small blocks is enough for large ones");

static int list_shifts(struct rf_shift shift[RF_MOST_SHIFTS], int reach)
{
    int n = 0;

    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            if (x * x + y * y <= reach * reach + 1)
                shift[n++] = (struct rf_shift){x, y};
    return n;
}

/* The number of values in a window of shifts, and where one lies in it. */
static int window_size(const struct rf_blocks *b)
{
    return (2 * b->reach + 1) * b->columns;
}

static int place_of(const struct rf_blocks *b, int shift)
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
    const struct rf_blocks *b;
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
static void smooth_blocks(const struct rf_blocks *b, int32_t *sum, int size)
{
    struct smoothing smoothing = {b, sum, size};

    rf_pool_run(b->e->pool, smooth_across, &smoothing, b->down);
    rf_pool_run(b->e->pool, smooth_down, &smoothing, b->across);
}

static ptrdiff_t block_of(const struct rf_blocks *b, const struct rf_map_edge *edge)
{
    return (ptrdiff_t)(edge->y / b->side) * b->across + edge->x / b->side;
}

/* The first edge in row y or below, a multiple of `every`. */
static int first_edge(const struct rf_blocks *b, int y)
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
    const struct rf_blocks *b = context;
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

/* Whether the run was cancelled: looked at in each row of blocks. */
static bool is_cancelled(const struct rf_blocks *b, ptrdiff_t block)
{
    return block % b->across == 0 && rf_run_cancelled(b->e->pool->run);
}

static void sum_support(struct rf_blocks *b)
{
    const int size = window_size(b);
    const ptrdiff_t n = (ptrdiff_t)b->across * b->down;

    memset(b->total, 0, (size_t)b->shifts * sizeof b->total[0]);
    for (ptrdiff_t k = 0; k < n && !is_cancelled(b, k); k++)
        for (int i = 0; i < b->shifts; i++)
            b->total[i] += b->support[k * size + place_of(b, i)];
}

/* Parts them around one of those that are left (Hoare's quickselect). */
int64_t rf_median(const int64_t *value, int n)
{
    int64_t left[RF_MOST_VALUES];
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
    struct rf_shift shift;
    double gain; /* in support over that in place, in medians; longer shifts have to gain more */
    double best; /* greatest support, in medians */
};

static struct wish ask_block(const struct rf_blocks *b, ptrdiff_t block)
{
    const int32_t *window = b->support + block * window_size(b);
    /* The median of no edge would be 0: half an edge with a gradient of a code is added. */
    const double count = b->count[block] + 128;
    struct wish wish = {{0, 0}, 0, 0};
    int64_t support[RF_MOST_SHIFTS] = {0};
    double middle, zero = 0, most = -1e9;

    for (int i = 0; i < b->shifts; i++)
        support[i] = window[place_of(b, i)];
    middle = (double)rf_median(support, b->shifts) / count + 16;
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
static void smooth_field(const struct rf_blocks *b, double *field)
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

double rf_ask_blocks(struct rf_blocks *b, double margin)
{
    const ptrdiff_t n = (ptrdiff_t)b->across * b->down;
    double content = 0, all = 0;

    b->every = rf_every_edge(b->e);
    rf_pool_run(b->e->pool, add_support, b, b->down);
    sum_support(b);
    smooth_blocks(b, b->count, 1);
    smooth_blocks(b, b->support, window_size(b));
    for (ptrdiff_t i = 0; i < n && !is_cancelled(b, i); i++) {
        const double count = b->count[i] / 256.0;
        struct wish wish;
        double clear, weight;

        b->right[i] = b->below[i] = b->weight[i] = 0;
        if (b->count[i] == 0)
            continue;
        wish = ask_block(b, i);
        clear = count * fmin(fmax(wish.best - 1.3, 0), 1);
        all += clear;
        content += rf_shift_length(wish.shift) <= 1.5 ? clear : 0;
        weight = wish.gain > margin ? count * fmin(wish.gain, 1) : count * 0.2;
        b->weight[i] = weight;
        if (wish.gain > margin) {
            b->right[i] = weight * wish.shift.x;
            b->below[i] = weight * wish.shift.y;
        }
    }
    if (rf_run_cancelled(b->e->pool->run)) /* not all are written */
        return 1;
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

struct rf_blocks rf_blocks_of(struct rf_edges *e, int side, int reach)
{
    struct rf_blocks b = {
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
        b.length[i] = rf_shift_length(b.shift[i]);
    return b;
}

/* The bytes that blocks of each size need. */
void rf_align_lay_out(struct rf_edges *e, struct rf_arena *arena)
{
    const uint64_t large = (uint64_t)((e->width + RF_LARGE_BLOCK - 1) / RF_LARGE_BLOCK) *
                           (uint64_t)((e->height + RF_LARGE_BLOCK - 1) / RF_LARGE_BLOCK);
    const uint64_t small = 4 * large;

    e->blocks.support = rf_arena_take(arena, small * SMALL_WINDOW, sizeof *e->blocks.support);
    e->blocks.count = rf_arena_take(arena, small, sizeof *e->blocks.count);
    e->blocks.right = rf_arena_take(arena, small, sizeof *e->blocks.right);
    e->blocks.below = rf_arena_take(arena, small, sizeof *e->blocks.below);
    e->blocks.weight = rf_arena_take(arena, small, sizeof *e->blocks.weight);
}
