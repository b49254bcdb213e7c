/* sort_rays.c: culls the slabs that each ray of a strip need not test, and sorts rays by number of
 * tests. */
#include "kernels/kernels.h"

enum { BITS = RF_JOIN_BLOCK, BLOCKS = RF_BINS / BITS };

/* The tests of all rays at once. */
struct state {
    uint16_t first[BLOCKS][RF_RAY_CHUNK];  /* bit k % BITS of block k / BITS: it tests slab k */
    uint16_t joined[BLOCKS][RF_RAY_CHUNK]; /* this bit: it tests it with slab k - 1 */
    uint16_t open[RF_RAY_CHUNK];           /* all bits: so far some pixel may pass */
    uint16_t tests[RF_RAY_CHUNK];
    uint16_t last[RF_RAY_CHUNK]; /* the slab that the ray ends in; their number: none of them */
    uint16_t from_background[RF_RAY_CHUNK]; /* all bits: there it sees the background layer; in the
                                             * end it is 1 for all rays that see this layer */
    uint16_t from[RF_BINS], until[RF_BINS]; /* the limits of the slabs, for rf_in_range() */
};

static inline uint16_t mask(int is_true)
{
    return (uint16_t)-is_true;
}

/* The blurs where rays look for a slab: from `least` to `most`. All bits of `in_background` are set
 * where the deepest surface is in the background layer too, and all bits of `same` where rays look
 * for the slab before in the same place. */
struct slab_ranges {
    int16_t least[RF_RAY_CHUNK], most[RF_RAY_CHUNK];
    uint16_t in_background[RF_RAY_CHUNK], same[RF_RAY_CHUNK];
};

/* Whether a slab is so narrow that the background layer has all of it where it has its deepest
 * surface. */
static bool is_thin(const struct rf_slab *slab)
{
    const int low = slab->low, high = low + slab->width;

    return slab->width <= rf_background_depth(low > 0 ? low : high < 0 ? high : 0);
}

/* Culls the tests of slab k. Returns whether any ray is still open. */
static bool cull_slab(struct state *restrict s, const struct rf_sort_job *job, int k,
                      const struct slab_ranges *restrict seen)
{
    const int16_t *restrict least = seen->least, *restrict most = seen->most;
    const uint16_t *restrict in_background = seen->in_background, *restrict same = seen->same;
    const int16_t low = job->slab[k].low, high = (int16_t)(low + job->slab[k].width);
    const uint16_t bit = (uint16_t)(1 << k % BITS), before = k % BITS ? bit / 2 : 0;
    const uint16_t may_join = job->joined[k] ? 0xffff : 0, slab = (uint16_t)k;
    const uint16_t may_pass = mask(job->skip_deepest && is_thin(&job->slab[k]));
    uint16_t *restrict first = s->first[k / BITS], *restrict joined = s->joined[k / BITS];
    uint16_t *restrict open = s->open, *restrict tests = s->tests, *restrict last = s->last;
    uint16_t *restrict from_background = s->from_background;
    uint16_t any = 0;

    for (int n = 0; n < job->rays; n++) {
        const uint16_t outside = mask(most[n] < low) | mask(least[n] > high);
        const uint16_t partly = mask(least[n] < low) | mask(most[n] > high);
        const uint16_t deepest = may_pass & in_background[n] & mask(most[n] <= high);
        const uint16_t some = open[n] & partly & (uint16_t)~outside;
        const uint16_t pass = some & deepest, test = some & (uint16_t)~deepest;
        const uint16_t all = open[n] & (uint16_t)~partly;
        const uint16_t beside = same[n] & mask(((first[n] | joined[n]) & before) != 0);
        const uint16_t join = test & beside & may_join, start = test & (uint16_t)~join;

        joined[n] |= join & bit;
        first[n] |= start & bit;
        tests[n] += (all & beside) - start; /* -1 is true */
        last[n] = ((all | pass) & slab) | ((uint16_t) ~(all | pass) & last[n]);
        from_background[n] |= pass;
        open[n] &= partly & (uint16_t)~pass;
        any |= open[n];
    }
    return any != 0;
}

/* How many slabs are joined to that of a bit. */
static inline int joined_to(uint32_t joined, int bit)
{
    return __builtin_ctz(~(joined >> (bit + 1)));
}

/* Chooses without a branch, as no processor could predict it. */
static inline const void *choose(bool first, const void *a, const void *b)
{
    const uintptr_t all = (uintptr_t)0 - first;

    return (const void *)(((uintptr_t)a & all) | ((uintptr_t)b & ~all));
}

/* How jobs differ in the loops over rays. */
struct way {
    bool weighted, shared, blocks; /* weights, chroma, more than one block of slabs */
};

/* Places the tests of ray n, which becomes the m-th. */
static RF_ALWAYS_INLINE void place_tests(struct rf_sorted_rays *restrict sorted,
                                         const struct rf_sort_job *restrict job,
                                         const struct state *restrict s, int n, int m,
                                         const int tests, const struct way way)
{
    uint32_t need = s->first[0][n];

    for (int t = 0, block = 0; t < tests; t++) {
        int k, bit;

        while (way.blocks && !need)
            need = s->first[++block][n];
        bit = __builtin_ctz(need);
        k = block * BITS + bit;
        need &= need - 1;
        sorted->from[t][m] = s->from[k];
        sorted->to[t][m] =
            (uint16_t)(s->until[k + joined_to(s->joined[block][n], bit)] - s->from[k]);
        sorted->offset[t][m] = job->offset[k][n];
        if (way.weighted)
            sorted->weight_offset[t][m] = job->weight_offset[k][n];
        if (way.shared && n < job->shared)
            sorted->chroma_offset[t][m] = job->chroma_offset[k][n];
        if (way.shared && way.weighted && n < job->shared)
            sorted->chroma_weight_offset[t][m] = job->chroma_weight_offset[k][n];
    }
}

/* Sets what ray n sees where no test hits. */
static RF_ALWAYS_INLINE void place_last(struct rf_sorted_rays *restrict sorted,
                                        const struct rf_sort_job *restrict job,
                                        const struct state *restrict s, int n, int m,
                                        const struct way way)
{
    const uint16_t *const light[2] = {job->front, job->background};
    const size_t last = s->last[n], background = s->from_background[n];

    sorted->last[m] = light[background] + job->offset[last][n];
    if (way.weighted) {
        sorted->last_is_background[m] = background;
        sorted->last_weight[m] =
            (const uint16_t *)choose(background, job->background_weight, job->weight) +
            *(const int32_t *)choose(background, &job->offset[last][n],
                                     &job->weight_offset[last][n]);
    }
    if (way.shared && n < job->shared)
        sorted->chroma_last[m] =
            (const uint16_t *)choose(background, job->chroma_background, job->chroma_front) +
            job->chroma_offset[last][n];
    if (way.shared && way.weighted && n < job->shared)
        sorted->chroma_last_weight[m] =
            (const uint16_t *)choose(background, job->background_weight, job->weight) +
            job->chroma_weight_offset[last][n];
}

/* Places rays order[first] to order[end - 1], which have `tests` tests each or, if that is
 * negative, as many as the state says. */
static RF_ALWAYS_INLINE void place_some(struct rf_sorted_rays *restrict sorted,
                                        const struct rf_sort_job *restrict job,
                                        const struct state *restrict s,
                                        const uint8_t *restrict order, int first, int end,
                                        const int tests, const struct way way)
{
    for (int m = first; m < end; m++) {
        const int n = order[m], own = tests < 0 ? s->tests[n] : tests;

        sorted->tests[m] = (uint8_t)own;
        place_tests(sorted, job, s, n, m, own, way);
        place_last(sorted, job, s, n, m, way);
    }
}

/* Counts lie in bytes of a word, as chains of memory accesses would take longer. One call for all
 * ways: it costs little beside 64 rays, and is long. */
static __attribute__((noinline)) void put_in_order(struct rf_sorted_rays *restrict sorted,
                                                   uint8_t *restrict order,
                                                   const struct rf_sort_job *restrict job,
                                                   const struct state *restrict s)
{
    const int first = job->shared;
    uint64_t count = 0, at, first_count;
    uint8_t class[RF_RAY_CHUNK]; /* bits from which its byte begins */

    for (int n = 0; n < job->rays; n++)
        class[n] =
            (uint8_t)(8 * (s->tests[n] < RF_SORTED_TESTS ? s->tests[n] : RF_SORTED_TESTS - 1));
    for (int n = 0; n < first; n++)
        count += UINT64_C(1) << class[n];
    first_count = count;
#pragma GCC unroll 4
    for (int n = first; n < job->rays; n++)
        count += UINT64_C(1) << class[n];
    at = count * UINT64_C(0x0101010101010101) << 8; /* sums of those before */
#pragma GCC unroll 8
    for (int i = 0; i < RF_SORTED_TESTS; i++) {
        sorted->begin[i] = (uint8_t)(at >> 8 * i);
        sorted->shared[i] = (uint8_t)(first_count >> 8 * i);
    }
    sorted->begin[RF_SORTED_TESTS] = (uint8_t)job->rays;
#pragma GCC unroll 4
    for (int n = 0; n < job->rays; n++) {
        order[at >> class[n] & 255] = (uint8_t)n;
        at += UINT64_C(1) << class[n];
    }
}

static RF_ALWAYS_INLINE void place_all(struct rf_sorted_rays *restrict sorted,
                                       const struct rf_sort_job *restrict job,
                                       const struct state *restrict s, const struct way way)
{
    const uint8_t *const begin = sorted->begin;
    uint8_t order[RF_RAY_CHUNK];

    put_in_order(sorted, order, job, s);
    place_some(sorted, job, s, order, begin[0], begin[1], 0, way);
    place_some(sorted, job, s, order, begin[1], begin[2], 1, way);
    place_some(sorted, job, s, order, begin[2], begin[3], 2, way);
    place_some(sorted, job, s, order, begin[3], job->rays, -1, way);
}

/* Finds the blurs where rays look for slab k, and whether they look for slab k - 1 there too. */
static inline void find_ranges(struct slab_ranges *restrict seen, const struct rf_sort_job *job,
                               int k)
{
    int16_t *restrict least = seen->least, *restrict most = seen->most;
    uint16_t *restrict in_background = seen->in_background, *restrict same = seen->same;
    const int32_t *restrict cell = job->cell[k], *restrict at = job->offset[k];
    const int32_t *restrict before = job->offset[k > 0 ? k - 1 : 0];

    for (int n = 0; n < job->rays; n++) {
        const uint32_t range = job->range[cell[n]];

        least[n] = rf_range_least(range);
        most[n] = rf_range_most(range);
        in_background[n] = mask((range & RF_IN_BACKGROUND) != 0);
    }
    for (int n = 0; job->below && n < job->rays; n++) {
        const uint32_t range = job->below[cell[n]];

        least[n] = rf_lesser(least[n], rf_range_least(range));
        most[n] = rf_greater(most[n], rf_range_most(range));
        in_background[n] &= mask((range & RF_IN_BACKGROUND) != 0);
    }
    for (int n = 0; n < job->rays; n++)
        same[n] = mask(at[n] == before[n]);
}

void RF_VEC(rf_sort_rays)(struct rf_sorted_rays *sorted, const struct rf_sort_job *job)
{
    const int rays = job->rays;
    uint16_t past_slabs = 0;
    struct state s;

    for (int n = 0; n < rays; n++) {
        s.open[n] = 0xffff;
        s.tests[n] = s.from_background[n] = 0;
        s.last[n] = (uint16_t)job->slabs;
    }
    for (int k = 0; k < job->slabs; k++) {
        s.from[k] = rf_range_from(&job->slab[k]);
        s.until[k] = rf_range_until(&job->slab[k]);
    }
    for (int k = 0; k < job->slabs; k++) {
        struct slab_ranges seen;

        for (int n = 0; k % BITS == 0 && n < rays; n++)
            s.first[k / BITS][n] = s.joined[k / BITS][n] = 0;
        find_ranges(&seen, job, k);
        if (!cull_slab(&s, job, k, &seen))
            break;
    }
    for (int n = 0; n < rays; n++) {
        const uint16_t past = mask(s.last[n] == job->slabs);

        s.from_background[n] = (uint16_t)((s.from_background[n] | past) & 1);
        past_slabs |= past;
    }
    sorted->rays = rays;
    sorted->past_slabs = past_slabs != 0;
    if (job->slabs > BITS)
        place_all(sorted, job, &s, (struct way){job->weight, job->shared, true});
    else if (job->weight && job->shared)
        place_all(sorted, job, &s, (struct way){true, true, false});
    else if (job->weight)
        place_all(sorted, job, &s, (struct way){true, false, false});
    else if (job->shared)
        place_all(sorted, job, &s, (struct way){false, true, false});
    else
        place_all(sorted, job, &s, (struct way){false, false, false});
}
