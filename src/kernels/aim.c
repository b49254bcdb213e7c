/* aim.c: what rays look at, written for the compiler's vectoriser; compiled like rows.c. */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <math.h>
#include <string.h>

static inline int16_t lesser(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static inline int16_t greater(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

enum { RUN = 64 }; /* cells at a time */

/* Columns first; then the least of four beside each other, of which every fourth counts. */
static void cells_run(int16_t *restrict least, int16_t *restrict most,
                      const int16_t *restrict blur, ptrdiff_t stride, int n)
{
    int16_t low[RF_CELL * RUN + 4], high[RF_CELL * RUN + 4];
    const int16_t *restrict a = blur, *restrict b = a + stride, *restrict c = b + stride,
                  *restrict d = c + stride;

    for (int x = 0; x < RF_CELL * n; x++) {
        low[x] = lesser(lesser(a[x], b[x]), lesser(c[x], d[x]));
        high[x] = greater(greater(a[x], b[x]), greater(c[x], d[x]));
    }
    for (int i = 0; i < n; i++) {
        const int16_t *l = low + RF_CELL * i, *h = high + RF_CELL * i;

        least[i] = lesser(lesser(l[0], l[1]), lesser(l[2], l[3]));
        most[i] = greater(greater(h[0], h[1]), greater(h[2], h[3]));
    }
}

static void RF_VEC(rf_cells)(int16_t *least, int16_t *most, const int16_t *blur,
                             ptrdiff_t stride, int n)
{
    for (int i = 0; i < n; i += RUN)
        cells_run(least + i, most + i, blur + RF_CELL * i, stride, n - i < RUN ? n - i : RUN);
}

static void repeat_ends(int16_t *row, int n, int left, int right)
{
    for (int x = 1; x <= left; x++)
        row[-x] = row[0];
    for (int x = 0; x < right; x++)
        row[n + x] = row[n - 1];
}

static void RF_VEC(rf_windows)(uint32_t *restrict range,
                               const int16_t *const least[RF_WINDOW_Y],
                               const int16_t *const most[RF_WINDOW_Y],
                               int16_t *restrict scratch, int n, int border)
{
    const int windows = n + 2 * border, beyond = border + RF_WINDOW_X - 1;
    int16_t *restrict low = scratch, *restrict high = scratch + n + border + beyond;
    const int16_t *restrict l0 = least[0], *restrict l1 = least[1], *restrict l2 = least[2];
    const int16_t *restrict m0 = most[0], *restrict m1 = most[1], *restrict m2 = most[2];

    for (int x = 0; x < n; x++) {
        low[border + x] = lesser(lesser(l0[x], l1[x]), l2[x]);
        high[border + x] = greater(greater(m0[x], m1[x]), m2[x]);
    }
    repeat_ends(low + border, n, border, beyond);
    repeat_ends(high + border, n, border, beyond);
    for (int x = 0; x < windows; x++) {
        const int16_t l = lesser(lesser(lesser(low[x], low[x + 1]),
                                        lesser(low[x + 2], low[x + 3])), low[x + 4]);
        const int16_t h = greater(greater(greater(high[x], high[x + 1]),
                                          greater(high[x + 2], high[x + 3])), high[x + 4]);

        range[x] = (uint16_t)l | (uint32_t)(uint16_t)h << 16;
    }
}

/* floor((u s + 2^22) / 2^23) by the high half of the product. */
static inline int16_t rounded(int16_t u, int16_t blur)
{
    return (int16_t)((int16_t)((int16_t)(u * blur >> 16) + 64) >> 7);
}

static void RF_VEC(rf_aim)(int32_t *restrict offset, int32_t *restrict cell,
                           const int16_t *restrict u, const int16_t *restrict v, int blur,
                           int32_t stride, int32_t cell_stride, int n)
{
    int16_t x[RF_RAY_CHUNK], y[RF_RAY_CHUNK];
    const int16_t s = (int16_t)blur;

    for (int i = 0; i < n; i++) {
        x[i] = rounded(u[i], s);
        y[i] = rounded(v[i], s);
    }
    for (int i = 0; i < n; i++) {
        offset[i] = x[i] + y[i] * stride;
        cell[i] = (x[i] >> 2) + (y[i] >> 2) * cell_stride;
    }
}

enum { BITS = RF_JOIN_BLOCK, BLOCKS = RF_BINS / BITS };

/* Of all rays at once: */
struct state {
    uint16_t first[BLOCKS][RF_RAY_CHUNK];  /* bit k % BITS of block k / BITS: test slab k, */
    uint16_t joined[BLOCKS][RF_RAY_CHUNK]; /* or with the one before */
    uint16_t open[RF_RAY_CHUNK];           /* all bits: no slab so far takes all */
    uint16_t tests[RF_RAY_CHUNK];
    uint16_t last[RF_RAY_CHUNK];           /* slab, or their number: the background */
    uint16_t from[RF_BINS], until[RF_BINS]; /* of the slabs, for rf_in_range() */
};

static inline uint16_t mask(int is_true)
{
    return (uint16_t)-is_true;
}

/* Slab k, seen by ray n where blurs lie from least[n] to most[n] and, with same[n], slab k - 1
 * too. Returns whether any ray is still open. */
static bool meet_slab(struct state *restrict s, const struct rf_sort_job *job, int k,
                      const int16_t *restrict least, const int16_t *restrict most,
                      const uint16_t *restrict same)
{
    const int16_t low = job->slab[k].low, high = (int16_t)(low + job->slab[k].width);
    const uint16_t bit = (uint16_t)(1 << k % BITS), before = k % BITS ? bit / 2 : 0;
    const uint16_t may_join = job->joined[k] ? 0xffff : 0, slab = (uint16_t)k;
    uint16_t *restrict first = s->first[k / BITS], *restrict joined = s->joined[k / BITS];
    uint16_t *restrict open = s->open, *restrict tests = s->tests, *restrict last = s->last;
    uint16_t any = 0;

    for (int n = 0; n < job->rays; n++) {
        const uint16_t outside = mask(most[n] < low) | mask(least[n] > high);
        const uint16_t partly = mask(least[n] < low) | mask(most[n] > high);
        const uint16_t test = open[n] & partly & (uint16_t)~outside;
        const uint16_t all = open[n] & (uint16_t)~partly;
        const uint16_t beside = same[n] & mask(((first[n] | joined[n]) & before) != 0);
        const uint16_t join = test & beside & may_join, start = test & (uint16_t)~join;

        joined[n] |= join & bit;
        first[n] |= start & bit;
        tests[n] += (all & beside) - start; /* -1 is true */
        last[n] = (all & slab) | ((uint16_t)~all & last[n]);
        open[n] &= partly;
        any |= open[n];
    }
    return any != 0;
}

/* How many slabs are joined to that of a bit. */
static inline int joined_to(uint32_t joined, int bit)
{
    return __builtin_ctz(~(joined >> (bit + 1)));
}

/* Ray n becomes the m-th. */
static inline void place(struct rf_sorted_rays *restrict sorted,
                         const struct rf_sort_job *restrict job,
                         const struct state *restrict s, int n, int m, const bool weighted,
                         const bool shared)
{
    const int tests = (int)s->tests[n], last = (int)s->last[n];
    uint32_t need = s->first[0][n];

    for (int t = 0, block = 0; t < tests; t++) {
        int k, bit;

        while (!need)
            need = s->first[++block][n];
        bit = __builtin_ctz(need);
        k = block * BITS + bit;
        need &= need - 1;
        sorted->from[t][m] = s->from[k];
        sorted->to[t][m] = (uint16_t)(s->until[k + joined_to(s->joined[block][n], bit)] -
                                      s->from[k]);
        sorted->offset[t][m] = job->offset[k][n];
        if (weighted)
            sorted->weight_offset[t][m] = job->weight_offset[k][n];
        if (shared && n < job->shared)
            sorted->chroma_offset[t][m] = job->chroma_offset[k][n];
        if (shared && weighted && n < job->shared)
            sorted->chroma_weight_offset[t][m] = job->chroma_weight_offset[k][n];
    }
    if (shared && weighted && n < job->shared)
        sorted->chroma_last_weight[m] =
            (last == job->slabs ? job->behind_weight : job->weight) +
            job->chroma_weight_offset[last][n];
    if (shared && n < job->shared)
        sorted->chroma_last[m] = (last == job->slabs ? job->chroma_behind : job->chroma_front) +
                                 job->chroma_offset[last][n];
    if (weighted) {
        sorted->last_behind[m] = last == job->slabs;
        sorted->last_weight[m] = last == job->slabs
                                     ? job->behind_weight + job->offset[last][n]
                                     : job->weight + job->weight_offset[last][n];
    }
    sorted->tests[m] = (uint8_t)tests;
    sorted->last[m] =
        (last == job->slabs ? job->behind : job->front) + job->offset[last][n];
}

/* Counts lie in bytes of a word, as chains of memory accesses would take longer. */
static inline int class_of(uint32_t tests)
{
    return 8 * (int)(tests < RF_SORTED_TESTS ? tests : RF_SORTED_TESTS - 1);
}

static inline void place_all(struct rf_sorted_rays *restrict sorted,
                             const struct rf_sort_job *restrict job,
                             const struct state *restrict s, const bool weighted,
                             const bool shared)
{
    const int first = shared ? job->shared : 0;
    uint64_t count = 0, at, first_count;

    for (int n = 0; n < first; n++)
        count += UINT64_C(1) << class_of(s->tests[n]);
    first_count = count;
    for (int n = first; n < job->rays; n++)
        count += UINT64_C(1) << class_of(s->tests[n]);
    at = count * UINT64_C(0x0101010101010101) << 8; /* sums of those before */
    for (int class = 0; class < RF_SORTED_TESTS; class++) {
        sorted->begin[class] = (uint8_t)(at >> 8 * class);
        sorted->shared[class] = (uint8_t)(first_count >> 8 * class);
    }
    sorted->begin[RF_SORTED_TESTS] = (uint8_t)job->rays;
    for (int n = 0; n < job->rays; n++) {
        const int class = class_of(s->tests[n]);

        place(sorted, job, s, n, (int)(at >> class & 255), weighted, shared);
        at += UINT64_C(1) << class;
    }
}

/* Where slab k is seen: the blurs there, and whether slab k - 1 is seen there too. */
static inline void look(int16_t *restrict least, int16_t *restrict most,
                        uint16_t *restrict same, const struct rf_sort_job *job, int k)
{
    const int32_t *restrict cell = job->cell[k], *restrict at = job->offset[k];
    const int32_t *restrict before = job->offset[k > 0 ? k - 1 : 0];

    for (int n = 0; n < job->rays; n++) {
        const uint32_t range = job->range[cell[n]];

        least[n] = (int16_t)range;
        most[n] = (int16_t)(range >> 16);
    }
    for (int n = 0; job->below && n < job->rays; n++) {
        const uint32_t range = job->below[cell[n]];

        least[n] = lesser(least[n], (int16_t)range);
        most[n] = greater(most[n], (int16_t)(range >> 16));
    }
    for (int n = 0; n < job->rays; n++)
        same[n] = mask(at[n] == before[n]);
}

static void RF_VEC(rf_sort_rays)(struct rf_sorted_rays *sorted, const struct rf_sort_job *job)
{
    const int rays = job->rays;
    struct state s;

    for (int n = 0; n < rays; n++) {
        s.open[n] = 0xffff;
        s.tests[n] = 0;
        s.last[n] = (uint16_t)job->slabs;
    }
    for (int k = 0; k < job->slabs; k++) {
        s.from[k] = rf_range_from(&job->slab[k]);
        s.until[k] = rf_range_until(&job->slab[k]);
    }
    for (int k = 0; k < job->slabs; k++) {
        int16_t least[RF_RAY_CHUNK], most[RF_RAY_CHUNK];
        uint16_t same[RF_RAY_CHUNK];

        for (int n = 0; k % BITS == 0 && n < rays; n++)
            s.first[k / BITS][n] = s.joined[k / BITS][n] = 0;
        look(least, most, same, job, k);
        if (!meet_slab(&s, job, k, least, most, same))
            break;
    }
    sorted->rays = rays;
    if (job->weight && job->shared)
        place_all(sorted, job, &s, true, true);
    else if (job->weight)
        place_all(sorted, job, &s, true, false);
    else if (job->shared)
        place_all(sorted, job, &s, false, true);
    else
        place_all(sorted, job, &s, false, false);
}

/* Square root and division are exact to the last bit everywhere. */
static void RF_VEC(rf_tolerances)(int32_t *restrict within, const int16_t *restrict u,
                                  const int16_t *restrict v, int n)
{
    for (int i = 0; i < n; i++) {
        const int32_t square = u[i] * u[i] + v[i] * v[i];
        const double most = 4194304.0 / sqrt(square); /* 2^22 = half in Q23 */

        within[i] = (int32_t)(most < 32766 ? most : 32766);
    }
}

static void RF_VEC(rf_settle)(uint8_t *settled, int32_t *offset, const uint32_t *range,
                              const int32_t *cell, const struct rf_search_rays *rays,
                              int tests, int32_t stride, int32_t cell_stride)
{
    const int32_t own = tests == 1 ? (int16_t)range[0] : INT16_MIN - 1;
    const int16_t *restrict u = rays->u, *restrict v = rays->v;
    const int32_t *restrict within = rays->within;
    const int n = rays->rays;
    uint32_t guess[RF_RAY_CHUNK], seen[RF_RAY_CHUNK];
    int32_t there[RF_RAY_CHUNK];
    int16_t x[RF_RAY_CHUNK], y[RF_RAY_CHUNK], same[RF_RAY_CHUNK];

    for (int i = 0; i < n; i++)
        guess[i] = range[cell[i]];
    for (int i = 0; i < n; i++) {
        const int16_t least = (int16_t)guess[i], most = (int16_t)(guess[i] >> 16);

        const int16_t far_x = rounded(u[i], most), far_y = rounded(v[i], most);

        x[i] = rounded(u[i], least);
        y[i] = rounded(v[i], least);
        same[i] = (x[i] == far_x) & (y[i] == far_y);
    }
    for (int i = 0; i < n; i++) {
        offset[i] = x[i] + y[i] * stride;
        there[i] = (x[i] >> 2) + (y[i] >> 2) * cell_stride;
    }
    for (int i = 0; i < n; i++)
        seen[i] = range[there[i]];
    for (int i = 0; i < n; i++) {
        const int32_t least = (int16_t)guess[i], most = (int32_t)guess[i] >> 16;
        const int32_t low = (int16_t)seen[i], high = (int32_t)seen[i] >> 16;

        settled[i] = (uint8_t)(same[i] & (((high - least <= within[i]) &
                                           (most - low <= within[i])) |
                                          (high <= own)));
    }
}

void RF_VEC(rf_aim_use)(struct rf_kernels *kernels)
{
    kernels->cells = RF_VEC(rf_cells);
    kernels->windows = RF_VEC(rf_windows);
    kernels->aim = RF_VEC(rf_aim);
    kernels->sort_rays = RF_VEC(rf_sort_rays);
    kernels->settle = RF_VEC(rf_settle);
    kernels->tolerances = RF_VEC(rf_tolerances);
}
