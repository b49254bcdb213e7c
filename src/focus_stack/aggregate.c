/* aggregate.c: costs of a focus stack are added up along eight directions, and the least is chosen.
 *
 * Along each direction, from the border of the map to each sample p with q before it,
 *
 *     L(p, k) = C(p, k) + min(L(q, k), L(q, k +- 1) + STEP, least(q) + JUMP(p, q)) - least(q)
 *
 * where least(q) is the least L(q, i) of all frames i. JUMP gets less where the colours of p and q
 * differ, but is never below STEP. Each L is at most 255 + JUMP + STEP, 791, so the sum of eight
 * fits 13 bits.
 */
#include "focus_stack/focus_stack.h"

#include <string.h>

enum {
    STEP = 24,
    JUMP = 512,
    EDGE = 12, /* codes of difference that halve a jump */
};

static int jump(const uint8_t *p, const uint8_t *q)
{
    const int most = rf_stack_difference(p, q);

    return JUMP * EDGE * EDGE / (EDGE * EDGE + most * most) + STEP;
}

/* One step of one direction: costs of q to those of p, which are added to the sum as well. Rows of
 * paths have a spare element on either side, which no minimum takes. n is known to the compiler. */
static inline void advance(int16_t *restrict to, const int16_t *restrict from,
                           const uint8_t *restrict cost, int16_t *restrict sum, int jump_cost,
                           int n)
{
    int16_t least = from[0];

    for (int k = 1; k < n; k++)
        least = from[k] < least ? from[k] : least;

    const int16_t far = (int16_t)(least + jump_cost);

    for (int k = 0; k < n; k++) {
        const int16_t below = (int16_t)(from[k - 1] + STEP);
        const int16_t above = (int16_t)(from[k + 1] + STEP);
        int16_t best = from[k] < far ? from[k] : far;

        best = below < best ? below : best;
        best = above < best ? above : best;
        to[k] = (int16_t)(best - least + cost[k]);
        sum[k] = (int16_t)(sum[k] + to[k]);
    }
}

enum {
    NEVER = 16384,
    WAYS = 4, /* in a pass: from beside, and from three samples of the row before */
};

/* Costs of a path that comes in at the border: nothing yet. */
static void enter(int16_t *to, const uint8_t *cost, int16_t *sum, int n)
{
    for (int k = 0; k < n; k++) {
        to[k] = cost[k];
        sum[k] = (int16_t)(sum[k] + cost[k]);
    }
}

/* A row of a pass; way is 1 downwards and to the right, -1 upwards and to the left. */
static inline void pass_row(const struct refocus_stack *s, int y, int way, bool first,
                            int16_t *const *last, int16_t *const *next, int n)
{
    const int w = s->columns, pitch = n + 2 * RF_STACK_PATHS_APART;
    int16_t *beside[2] = {next[WAYS - 1], last[WAYS - 1]}; /* this sample and the last one */

    for (int i = 0; i < w; i++) {
        const int x = way > 0 ? i : w - 1 - i;
        const size_t at = (size_t)y * (size_t)w + (size_t)x;
        const uint8_t *cost = s->cost + at * (size_t)n, *guide = s->guide + 3 * at;
        int16_t *sum = s->sum + at * (size_t)n;
        int16_t *t = beside[0];

        if (i)
            advance(beside[0], beside[1], cost, sum, jump(guide, guide - 3 * way), n);
        else
            enter(beside[0], cost, sum, n);
        beside[0] = beside[1];
        beside[1] = t;
        for (int d = -1; d <= 1; d++) {
            int16_t *to = next[d + 1] + (ptrdiff_t)x * pitch;
            const ptrdiff_t back = (ptrdiff_t)way * w - d; /* samples to where it comes from */

            if (first || x + d < 0 || x + d >= w)
                enter(to, cost, sum, n);
            else
                advance(to, last[d + 1] + (ptrdiff_t)(x + d) * pitch, cost, sum,
                        jump(guide, guide - 3 * back), n);
        }
    }
}

static inline void pass(const struct refocus_stack *s, struct rf_stack_part part, int n)
{
    const ptrdiff_t row = (ptrdiff_t)(n + 2 * RF_STACK_PATHS_APART) * s->columns;
    int16_t *const path = rf_stack_path(s, part.way), *line[2][WAYS];

    for (ptrdiff_t i = 0; i < 2 * WAYS * row && !part.begin; i++)
        path[i] = NEVER;
    for (int i = 0; i < 2 * WAYS; i++)
        line[i & 1][i / 2] = path + i * row + RF_STACK_PATHS_APART;
    for (int i = part.begin; i < part.end; i++) {
        const int y = part.way > 0 ? i : s->rows - 1 - i;
        const size_t sums = (size_t)s->columns * (size_t)n;

        if (!part.second)
            memset(s->sum + (size_t)y * sums, 0, sums * sizeof *s->sum);
        pass_row(s, y, part.way, i == 0, line[i & 1], line[~i & 1], n);
    }
}

static void pass_part(void *context, struct rf_stack_part part)
{
    const struct refocus_stack *s = context;

    if (s->labels == 8)
        pass(s, part, 8);
    else if (s->labels == 16)
        pass(s, part, 16);
    else if (s->labels == 24)
        pass(s, part, 24);
    else
        pass(s, part, REFOCUS_STACK_MOST_FRAMES);
}

void rf_stack_aggregate(struct refocus_stack *s)
{
    rf_stack_both_ways(s->pool, pass_part, s, s->rows);
}

/* The least of the parabola through three sums, Q8 from the middle one; at most half a frame. */
static int between(int before, int least, int after)
{
    const int bend = before + after - 2 * least;

    return bend > 0 ? rf_stack_clamp(128 * (before - after) / bend + 128, 256) - 128 : 0;
}

static void choose_row(void *context, int y, int worker)
{
    struct refocus_stack *const s = context;
    const size_t begin = (size_t)y * (size_t)s->columns, end = begin + (size_t)s->columns;

    (void)worker;
    for (size_t i = begin; i < end; i++) {
        const int16_t *sum = s->sum + i * (size_t)s->labels;
        int best = 0;

        for (int k = 1; k < s->depths; k++)
            best = sum[k] < sum[best] ? k : best;
        s->depth[i] = (uint16_t)(256 * best);
        if (best > 0 && best + 1 < s->depths)
            s->depth[i] =
                (uint16_t)(s->depth[i] + between(sum[best - 1], sum[best], sum[best + 1]));
    }
}

void rf_stack_choose(struct refocus_stack *s)
{
    rf_pool_run(s->pool, choose_row, s, s->rows);
}
