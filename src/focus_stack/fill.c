/* fill.c: each sample takes the depth that most of the sure samples around it have.
 *
 * A sure sample votes for its depth, with its confidence. Votes are handed on from sample to
 * sample, along rows first and then along columns, or along columns first: the second time takes
 * the combs away that the first leaves, since what reaches a sample comes along its column in the
 * end. Each step keeps KEEP / 256 of them, and less across edges of the photo. The depth with the
 * most votes is taken, between frames in proportion to the votes of its neighbours. A sample counts
 * its own vote OWN times, so that speckles go and thin things stay. No vote comes from where
 * nothing is sure: depth stays as it was chosen.
 *
 * Votes of a row are below OWN 255 + 2 * 255 * 128 < 2^17, those of a column 128 times as much,
 * 2^24, so that a product with KEEP fits 32 bits. The planes of costs, sums, paths and moved
 * sharpness lend their memory.
 */
#include "focus_stack/focus_stack.h"

#include <stdbool.h>
#include <string.h>

enum {
    KEEP = 254,
    OWN = 16,
    EDGE = 16 /* codes of difference that halve what is kept */
};

static uint32_t kept(const uint8_t *p, const uint8_t *q)
{
    const int most = rf_stack_difference(p, q);

    return (uint32_t)(KEEP * EDGE * EDGE / (EDGE * EDGE + most * most));
}

/* The vote of each sample, 0 to 255 in all, shared by the two frames that its depth lies between;
 * it takes the place of its costs. */
static void vote_row(void *context, int y, int worker)
{
    const struct refocus_stack *s = context;
    const size_t w = (size_t)s->columns, n = (size_t)s->labels, begin = (size_t)y * w;

    (void)worker;
    memset(s->cost + begin * n, 0, w * n);
    for (size_t i = begin; i < begin + w; i++) {
        const int k = s->depth[i] >> 8, t = s->depth[i] & 255;
        uint8_t *own = s->cost + i * n + k;

        own[0] = (uint8_t)(s->sure[i] * (256 - t) >> 8);
        if (t)
            own[1] = (uint8_t)(s->sure[i] * t >> 8);
    }
}

/* The map as votes go through it: rows first, or columns. */
struct walk {
    const struct refocus_stack *stack;
    int width, height;
    ptrdiff_t across, down; /* samples to the next one */
};

/* Votes that reach each sample of row y along it. n is known to the compiler. */
static inline void along_row(const struct refocus_stack *s, const struct walk *walk, int y,
                             uint32_t *restrict votes, int n)
{
    const int w = walk->width;
    uint32_t sum[REFOCUS_STACK_MOST_FRAMES];

    for (int way = 1; way >= -1; way -= 2) {
        memset(sum, 0, sizeof sum);
        for (int i = 0; i < w; i++) {
            const size_t x = (size_t)(way > 0 ? i : w - 1 - i);
            const ptrdiff_t at = y * walk->down + (ptrdiff_t)x * walk->across;
            const uint8_t *own = s->cost + at * n;
            const uint8_t *guide = s->guide + 3 * at;
            const uint32_t keep = i ? kept(guide, guide - 3 * way * walk->across) : 0;
            uint32_t *to = votes + x * (size_t)n;

            for (int k = 0; k < n; k++) {
                const uint32_t here = sum[k] * keep >> 8;

                to[k] = way > 0 ? here + (uint32_t)own[k] * OWN : to[k] + here;
                sum[k] = here + own[k];
            }
        }
    }
}

/* The depth with the most votes, Q8 frames; as it was where there are none. */
static uint16_t elected(const uint32_t *votes, int count, uint16_t depth)
{
    uint64_t all = 0, sum = 0;
    int best = 0;

    for (int k = 1; k < count; k++)
        best = votes[k] > votes[best] ? k : best;
    if (!votes[best])
        return depth;

    const int first = best ? best - 1 : 0;

    for (int k = first; k <= best + 1 && k < count; k++) {
        all += votes[k];
        sum += (uint64_t)votes[k] * (uint64_t)(k - first);
    }
    return (uint16_t)(256 * first + (int)(256 * sum / all));
}

/* Sums of the votes that reach a sample from one side, in 16 bits; returns by how many bits they
 * are less. */
static inline uint16_t store(uint16_t *stored, const uint32_t *votes, int n)
{
    uint32_t most = 0;
    uint16_t shift = 0;

    for (int k = 0; k < n; k++)
        most |= votes[k];
    while (most >> shift > UINT16_MAX)
        shift++;
    for (int k = 0; k < n; k++)
        stored[k] = (uint16_t)(votes[k] >> shift);
    return shift;
}

/* Votes of row y and of the rows before it, on the way down or up: they are stored for the other
 * way, or the sample has those of that way and elects. */
static inline void next_row(const struct refocus_stack *s, const struct walk *walk, int y,
                            struct rf_stack_part part, bool first, int n)
{
    const int w = walk->width, way = part.way;
    uint32_t *votes = (uint32_t *)(void *)rf_stack_path(s, way);
    uint32_t *sums = votes + (size_t)w * (size_t)n;

    along_row(s, walk, y, votes, n);
    for (int x = 0; x < w; x++) {
        const ptrdiff_t i = y * walk->down + x * walk->across;
        const uint8_t *guide = s->guide + 3 * i;
        const uint32_t keep = first ? 0 : kept(guide, guide - 3 * way * walk->down);
        uint16_t *stored = (uint16_t *)s->sum + i * n;
        uint32_t *sum = sums + (size_t)x * (size_t)n, *vote = votes + (size_t)x * (size_t)n;
        uint32_t all[REFOCUS_STACK_MOST_FRAMES];

        for (int k = 0; k < n; k++)
            sum[k] = sum[k] * keep >> 8;
        if (part.second) {
            for (int k = 0; k < n; k++)
                all[k] = sum[k] + ((uint32_t)stored[k] << s->moved[i]);
            s->depth[i] = elected(all, s->depths, s->depth[i]);
        }
        for (int k = 0; k < n; k++)
            sum[k] += vote[k];
        if (!part.second)
            s->moved[i] = store(stored, sum, n);
    }
}

static inline void along_columns(const struct walk *walk, struct rf_stack_part part, int n)
{
    const struct refocus_stack *s = walk->stack;

    if (!part.begin)
        memset(rf_stack_path(s, part.way), 0,
               2 * sizeof(uint32_t) * (size_t)walk->width * (size_t)n);
    for (int i = part.begin; i < part.end; i++)
        next_row(s, walk, part.way > 0 ? i : walk->height - 1 - i, part, i == 0, n);
}

static void walk_part(void *context, struct rf_stack_part part)
{
    const struct walk *walk = context;

    if (walk->stack->labels == 8)
        along_columns(walk, part, 8);
    else if (walk->stack->labels == 16)
        along_columns(walk, part, 16);
    else if (walk->stack->labels == 24)
        along_columns(walk, part, 24);
    else
        along_columns(walk, part, REFOCUS_STACK_MOST_FRAMES);
}

void rf_stack_fill(struct refocus_stack *s, bool columns_first)
{
    struct walk rows = {s, s->columns, s->rows, 1, s->columns};
    struct walk columns = {s, s->rows, s->columns, s->columns, 1};
    struct walk *walk = columns_first ? &columns : &rows;

    rf_pool_run(s->pool, vote_row, s, s->rows);
    rf_stack_both_ways(s->pool, walk_part, walk, walk->height);
}
