/* order.c: the order of focus of frames that come without positions, by their sharpness.
 *
 * In the right order the sharpness of each part of the picture rises to one peak and falls. With
 * p(b, k) the sharpness of block b in frame k, in parts of its sharpest frame, an order costs
 *
 *     sum over b and k of min(most p(b, i) before k, most p(b, j) after k) - p(b, k)
 *
 * where that is above 0, what lies in valleys, and a tenth of the sum of |p(b, k) - p(b, k + 1)|,
 * since neighbours are alike. Valleys of three frames with .2, .9 and .4 are 0 deep, with .9, .2
 * and .4 they are .2. An order and its reverse cost the same: which end is far is told by edges,
 * once there is depth (direction.c).
 *
 * The shortest path through all frames, by the second sum alone, comes near: each frame is its
 * start once, and parts of it are turned while that makes it shorter. From there and from the order
 * that was given, frames are moved and parts turned while the cost falls.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <string.h>

enum {
    BLOCKS = 144,     /* along the longer side: larger ones hold surfaces of two depths, with two
                         peaks (a fence) */
    LOOKED_AT = 2000, /* at the most, in all */
    VALLEYS = 10,     /* weight of valleys */
    LEAST = 20 << 4,  /* texture that noise hides, as in costs.c: 20 codes, Q4 */
    ONE = 256,        /* sharpness of the sharpest frame */
    KEPT = 200,       /* the given order stays where it costs less than ONE / KEPT more a block */
    MOST = REFOCUS_STACK_MOST_FRAMES,
};

struct blocks {
    int frames, count;
    const uint16_t *sharp; /* `frames` of a block */
    uint32_t apart[MOST][MOST];
};

/* The root of the mean square of sharpness in a block, which a frame shows somewhere else. */
static int mean_of(const struct refocus_stack *s, const struct rf_stack_frame *frame, int x, int y,
                   int side)
{
    const double half = 0.5 * s->reduced * side;
    const struct rf_stack_line at =
        rf_stack_line(s, frame, x * s->reduced + half, y * s->reduced + half, 0);
    const int px = (int)(at.x >> 32), py = (int)(at.y >> 32);
    const int left = rf_stack_clamp(px / s->reduced - side / 2, s->columns - side);
    const int top = rf_stack_clamp(py / s->reduced - side / 2, s->rows - side);
    uint64_t sum = 0;

    for (int v = top; v < top + side; v++)
        for (int u = left; u < left + side; u++) {
            const uint64_t e = frame->sharpness[(size_t)v * (size_t)s->columns + (size_t)u];

            sum += e * e;
        }
    return (int)sqrt((double)(sum / ((uint64_t)side * (uint64_t)side)));
}

/* Blocks of texture whose sharpness differs from frame to frame, in the memory of `sum`. */
static void measure(const struct refocus_stack *s, struct blocks *blocks)
{
    const int longer = s->columns > s->rows ? s->columns : s->rows;
    const int side = longer > BLOCKS ? longer / BLOCKS : 1;
    uint16_t *out = (uint16_t *)s->sum;

    blocks->frames = s->count;
    blocks->count = 0;
    blocks->sharp = out;
    for (int y = 0; y + side <= s->rows; y += side)
        for (int x = 0; x + side <= s->columns; x += side) {
            int mean[MOST], least = INT32_MAX, most = 0;

            for (int k = 0; k < s->count; k++) {
                mean[k] = mean_of(s, &s->frame[k], x, y, side);
                least = mean[k] < least ? mean[k] : least;
                most = mean[k] > most ? mean[k] : most;
            }
            /* Half of the squared sharpness at the most, as for confidence. */
            if (most < LEAST || 2 * (int64_t)least * least > (int64_t)most * most)
                continue;
            for (int k = 0; k < s->count; k++)
                *out++ = (uint16_t)(mean[k] * ONE / most);
            blocks->count++;
        }
}

/* Leaves some of many blocks, all over the picture, and tells how far frames are apart in them. */
static void compare(struct blocks *blocks, uint16_t *sharp)
{
    const int n = blocks->frames, apart = blocks->count / LOOKED_AT + 1;

    for (int b = 0; b * apart < blocks->count; b++)
        memmove(sharp + (ptrdiff_t)b * n, sharp + (ptrdiff_t)b * apart * n,
                (size_t)n * sizeof *sharp);
    blocks->count = (blocks->count + apart - 1) / apart;
    memset(blocks->apart, 0, sizeof blocks->apart);
    for (int b = 0; b < blocks->count; b++) {
        const uint16_t *p = blocks->sharp + (ptrdiff_t)b * n;

        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                blocks->apart[i][j] += (uint32_t)abs(p[i] - p[j]);
    }
}

static int64_t length_of(const struct blocks *blocks, const uint8_t *order)
{
    int64_t sum = 0;

    for (int k = 0; k + 1 < blocks->frames; k++)
        sum += blocks->apart[order[k]][order[k + 1]];
    return sum;
}

/* VALLEYS times the cost. */
static int64_t cost_of(const struct blocks *blocks, const uint8_t *order)
{
    const int n = blocks->frames;
    int64_t sum = 0;

    for (int b = 0; b < blocks->count; b++) {
        const uint16_t *p = blocks->sharp + (ptrdiff_t)b * n;
        int after[MOST], before = 0;

        after[n - 1] = 0;
        for (int k = n - 1; k > 0; k--)
            after[k - 1] = p[order[k]] > after[k] ? p[order[k]] : after[k];
        for (int k = 0; k < n; k++) {
            const int here = p[order[k]], lower = before < after[k] ? before : after[k];

            sum += lower > here ? lower - here : 0;
            before = here > before ? here : before;
        }
    }
    return VALLEYS * sum + length_of(blocks, order);
}

static void turn(uint8_t *out, const uint8_t *order, int n, int first, int last)
{
    for (int k = 0; k < n; k++)
        out[k] = order[k < first || k > last ? k : first + last - k];
}

/* The frame at `from` comes to lie at `to`. */
static void shift(uint8_t *out, const uint8_t *order, int n, int from, int to)
{
    memmove(out, order, (size_t)n);
    if (from < to)
        memmove(out + from, order + from + 1, (size_t)(to - from));
    else
        memmove(out + to + 1, order + to, (size_t)(from - to));
    out[to] = order[from];
}

typedef int64_t value_of(const struct blocks *blocks, const uint8_t *order);

/* Takes each change that makes the value less, until there is none. Each lowers a whole number. */
static int64_t improve(const struct blocks *blocks, uint8_t *order, value_of *value)
{
    const int n = blocks->frames;
    int64_t best = value(blocks, order);

    for (bool better = true; better;) {
        better = false;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                uint8_t other[MOST];

                for (int way = i < j ? 0 : 1; way < 2; way++) {
                    if (way)
                        shift(other, order, n, i, j);
                    else
                        turn(other, order, n, i, j);

                    const int64_t now = value(blocks, other);

                    if (now < best) {
                        memcpy(order, other, (size_t)n);
                        best = now;
                        better = true;
                    }
                }
            }
    }
    return best;
}

/* From a frame always on to the one that is most alike. */
static void walk(const struct blocks *blocks, uint8_t *order, int start)
{
    const int n = blocks->frames;
    bool taken[MOST] = {false};

    order[0] = (uint8_t)start;
    taken[start] = true;
    for (int k = 1; k < n; k++) {
        const uint32_t *apart = blocks->apart[order[k - 1]];
        int next = -1;

        for (int i = 0; i < n; i++)
            if (!taken[i] && (next < 0 || apart[i] < apart[next]))
                next = i;
        order[k] = (uint8_t)next;
        taken[next] = true;
    }
}

static int64_t search(const struct blocks *blocks, uint8_t *order)
{
    int64_t shortest = INT64_MAX, cost;
    uint8_t other[MOST];

    for (int start = 0; start < blocks->frames; start++) {
        walk(blocks, other, start);

        const int64_t length = improve(blocks, other, length_of);

        if (length < shortest) {
            shortest = length;
            memcpy(order, other, sizeof other);
        }
    }
    cost = improve(blocks, order, cost_of);
    for (int k = 0; k < blocks->frames; k++)
        other[k] = (uint8_t)k;

    const int64_t from_given = improve(blocks, other, cost_of);

    if (from_given < cost)
        memcpy(order, other, sizeof other);
    return from_given < cost ? from_given : cost;
}

/* The least cost of an order with one frame elsewhere. Moving one of two is their reverse. */
static int64_t next_best(const struct blocks *blocks, const uint8_t *order)
{
    const int n = blocks->frames;
    int64_t least = INT64_MAX;

    for (int i = 0; n > 2 && i < n; i++)
        for (int j = 0; j < n; j++) {
            uint8_t other[MOST];

            shift(other, order, n, i, j);
            if (i != j) {
                const int64_t cost = cost_of(blocks, other);

                least = cost < least ? cost : least;
            }
        }
    return least;
}

/* An order becomes its reverse if that has more pairs as they were given. */
static void direct(uint8_t *order, int n)
{
    int pairs = 0;
    uint8_t other[MOST];

    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            pairs += order[i] < order[j] ? 1 : -1;
    if (pairs < 0) {
        memcpy(other, order, (size_t)n);
        turn(order, other, n, 0, n - 1);
    }
}

static void put(struct refocus_stack *s, const uint8_t *order)
{
    /* Frames are numbered in the order that they were added in, which they have here. */
    for (int k = 0; k < s->count; k++) {
        int from = k;

        while (s->frame[from].added != order[k] + 1)
            from++;

        const struct rf_stack_frame frame = s->frame[from];

        s->frame[from] = s->frame[k];
        s->frame[k] = frame;
        s->frame[k].position = k;
    }
}

float rf_stack_find_order(struct refocus_stack *s)
{
    struct blocks blocks;
    uint8_t order[MOST], given[MOST];
    int64_t cost, least;

    rf_stack_align_each(s, s->count / 2);
    measure(s, &blocks);
    if (!blocks.count)
        return 0;
    compare(&blocks, (uint16_t *)s->sum);
    for (int k = 0; k < s->count; k++)
        given[k] = (uint8_t)k;
    cost = search(&blocks, order);
    if (cost_of(&blocks, given) * KEPT <= cost * KEPT + (int64_t)VALLEYS * ONE * blocks.count) {
        memcpy(order, given, sizeof given);
        cost = cost_of(&blocks, given);
    }
    direct(order, s->count);
    put(s, order);
    least = next_best(&blocks, order);
    return least == INT64_MAX ? 1
           : least > cost ? (float)((double)(least - cost) / ((double)VALLEYS * ONE * blocks.count))
                          : 0;
}
