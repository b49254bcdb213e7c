/* smooth.c: depth that was not measured becomes smooth between what was.
 *
 * Votes (fill.c) choose one of the depths around a sample, so that depth which nothing measured has
 * steps and combs, and the photo seams, where the vote changes: on walls, paper and the sky. Here
 * each sample gets a weighted mean of depth, to the extent that it was not measured itself:
 *
 *     sure d + (1 - sure) (sum w_i k_i d_i) / (sum w_i k_i),  w = sure + LEAST
 *
 * (normalised convolution, Knutsson & Westin 1993). What k keeps of a neighbour is handed on from
 * sample to sample, along rows and columns, both ways, and less across edges of the photo (a
 * recursive filter as in Gastal & Oliveira 2011). Rounds with ever shorter lengths take away the
 * stripes that the longer ones leave. Differences that noise makes are no edges: its squared
 * sharpness, of second differences, is several times their squares, and stands for EDGE where it
 * is more.
 *
 * Sums are below 2^9 2^13 and Q8, weights are Q8, too, so that a difference times k, Q16, fits 47
 * bits.
 */
#include "focus_stack/focus_stack.h"

enum {
    ROUNDS = 5,
    LENGTH = 1024, /* samples over which the first round keeps 1 / e */
    SHORTER = 3,   /* by this factor each round */
    LEAST = 4,     /* the weight of depth that was voted for alone, beside 255 */
    EDGE = 256,    /* squared codes of difference that halve the root of what is kept */
    BAND = 32,     /* rows or columns that a worker takes at a time */
};

/* Planes of a sample each, in the memory of costs and their sums. */
struct planes {
    const struct refocus_stack *stack;
    int32_t *sum, *weight;
    uint8_t *across, *down; /* differences of the guide to the sample before, to the one above */
    int32_t kept[256];      /* by the difference of two neighbours, Q16 */
};

static void set_length(struct planes *p, int64_t length)
{
    const int64_t edge = p->stack->noise > EDGE ? p->stack->noise : EDGE;

    for (int64_t d = 0; d < 256; d++) {
        const int64_t root = (edge << 16) / (edge + d * d);

        p->kept[d] = (int32_t)((root * root >> 16) * length / (length + 1));
    }
}

/* Differences of the guide between all neighbours. */
static void find_differences(const struct planes *p)
{
    const uint8_t *guide = p->stack->guide;
    const ptrdiff_t w = p->stack->columns, samples = w * p->stack->rows;

    for (ptrdiff_t i = 1; i < samples; i++)
        p->across[i] = (uint8_t)rf_stack_difference(guide + 3 * i, guide + 3 * (i - 1));
    for (ptrdiff_t i = w; i < samples; i++)
        p->down[i] = (uint8_t)rf_stack_difference(guide + 3 * i, guide + 3 * (i - w));
}

/* Mixes the sample at `from` into that at `to`. */
static inline void hand_on(const struct planes *p, ptrdiff_t to, ptrdiff_t from, int difference)
{
    const int64_t kept = p->kept[difference];

    p->sum[to] += (int32_t)((p->sum[from] - p->sum[to]) * kept / 65536);
    p->weight[to] += (int32_t)((p->weight[from] - p->weight[to]) * kept / 65536);
}

static void along_rows(void *context, int band, int worker)
{
    const struct planes *p = context;
    const int w = p->stack->columns, below = (band + 1) * BAND;
    const int end = below < p->stack->rows ? below : p->stack->rows;

    (void)worker;
    for (int y = band * BAND; y < end; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * w;

        for (int x = 1; x < w; x++)
            hand_on(p, row + x, row + x - 1, p->across[row + x]);
        for (int x = w - 2; x >= 0; x--)
            hand_on(p, row + x, row + x + 1, p->across[row + x + 1]);
    }
}

static void along_columns(void *context, int band, int worker)
{
    const struct planes *p = context;
    const ptrdiff_t w = p->stack->columns, h = p->stack->rows, right = (band + 1) * BAND;
    const ptrdiff_t end = right < w ? right : w;

    (void)worker;
    for (ptrdiff_t y = 1; y < h; y++)
        for (ptrdiff_t i = y * w + band * BAND; i < y * w + end; i++)
            hand_on(p, i, i - w, p->down[i]);
    for (ptrdiff_t y = h - 2; y >= 0; y--)
        for (ptrdiff_t i = y * w + band * BAND; i < y * w + end; i++)
            hand_on(p, i, i + w, p->down[i + w]);
}

void rf_stack_smooth(struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    struct planes planes = {
        .stack = s,
        .sum = (int32_t *)(void *)s->sum,
        .weight = (int32_t *)(void *)s->sum + samples,
        .across = s->cost,
        .down = s->cost + samples,
    };
    int length = LENGTH;

    find_differences(&planes);
    for (size_t i = 0; i < samples; i++) {
        planes.weight[i] = (s->sure[i] + LEAST) << 8;
        planes.sum[i] = planes.weight[i] * s->depth[i];
    }
    for (int i = 0; i < ROUNDS; i++, length /= SHORTER) {
        set_length(&planes, length);
        rf_pool_run(s->pool, along_rows, &planes, (s->rows + BAND - 1) / BAND);
        rf_pool_run(s->pool, along_columns, &planes, (s->columns + BAND - 1) / BAND);
    }
    for (size_t i = 0; i < samples; i++) {
        const int32_t mean = planes.sum[i] / planes.weight[i], sure = s->sure[i];

        s->depth[i] = (uint16_t)((sure * s->depth[i] + (255 - sure) * mean + 127) / 255);
    }
}
