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
    uint32_t first[BLOCKS][RF_RAY_CHUNK];  /* bit k % 32 of block k / 32: test slab k, */
    uint32_t joined[BLOCKS][RF_RAY_CHUNK]; /* or with the one before */
    uint32_t open[RF_RAY_CHUNK];         /* ~0: no slab so far takes all */
    uint32_t tests[RF_RAY_CHUNK];
    uint32_t last[RF_RAY_CHUNK];         /* slab, or their number: the background */
};

/* Returns whether any ray is still open. */
static bool meet_slab(struct state *restrict s, const uint32_t *restrict seen,
                      const struct rf_sort_job *job, int k)
{
    const int32_t low = job->slab[k].low, high = low + job->slab[k].width;
    const bool inner = k % BITS > 0;
    const int32_t *restrict at = job->offset[k], *restrict before = job->offset[k - inner];
    const uint32_t bit = UINT32_C(1) << k % BITS;
    const uint32_t bit_before = inner ? bit >> 1 : 0, may_join = job->joined[k] ? bit : 0;
    uint32_t *restrict first = s->first[k / BITS], *restrict joined = s->joined[k / BITS];
    uint32_t *restrict open = s->open, *restrict tests = s->tests, *restrict last = s->last;
    uint32_t any = 0;

    for (int n = 0; n < job->rays; n++) {
        const int32_t least = (int16_t)seen[n], most = (int32_t)seen[n] >> 16;
        const uint32_t outside = (uint32_t)-((most < low) | (least > high));
        const uint32_t inside = (uint32_t)-((least >= low) & (most <= high));
        const uint32_t test = open[n] & ~(outside | inside);
        const uint32_t all = open[n] & inside;
        /* the slab before is tested, and seen at the same place */
        const uint32_t beside = (uint32_t)-(((first[n] | joined[n]) & bit_before) != 0) &
                                (uint32_t)-(at[n] == before[n]);
        const uint32_t join = test & beside & may_join;

        joined[n] |= join;
        first[n] |= test & ~join & bit;
        tests[n] += (all & beside) - (test & ~(uint32_t)-(join != 0)); /* -1 is true */
        last[n] = (all & (uint32_t)k) | (~all & last[n]);
        open[n] &= ~inside;
        any |= open[n];
    }
    return any != 0;
}

/* How many slabs are joined to that of a bit. */
static inline int joined_to(uint32_t joined, int bit)
{
    return __builtin_ctz(~(joined >> bit >> 1));
}

/* Ray n becomes the m-th. */
static inline void place(struct rf_sorted_rays *restrict sorted,
                         const struct rf_sort_job *restrict job,
                         const struct state *restrict s, int n, int m, const bool weighted)
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
        sorted->from[t][m] = rf_range_from(&job->slab[k]);
        sorted->to[t][m] =
            rf_range_to(&job->slab[k], &job->slab[k + joined_to(s->joined[block][n], bit)]);
        sorted->offset[t][m] = job->offset[k][n];
        if (weighted)
            sorted->weight_offset[t][m] = job->weight_offset[k][n];
    }
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
                             const struct state *restrict s, const bool weighted)
{
    uint64_t count = 0, at;

    for (int n = 0; n < job->rays; n++)
        count += UINT64_C(1) << class_of(s->tests[n]);
    at = count * UINT64_C(0x0101010101010101) << 8; /* sums of those before */
    for (int n = 0; n < job->rays; n++) {
        const int class = class_of(s->tests[n]);

        place(sorted, job, s, n, (int)(at >> class & 255), weighted);
        at += UINT64_C(1) << class;
    }
}

/* One range of two. */
static inline uint32_t both(uint32_t a, uint32_t b)
{
    return (uint16_t)lesser((int16_t)a, (int16_t)b) |
           (uint32_t)(uint16_t)greater((int16_t)(a >> 16), (int16_t)(b >> 16)) << 16;
}

static void RF_VEC(rf_sort_rays)(struct rf_sorted_rays *sorted, const struct rf_sort_job *job)
{
    const int rays = job->rays;
    struct state s;

    for (int n = 0; n < rays; n++) {
        s.open[n] = UINT32_MAX;
        s.tests[n] = 0;
        s.last[n] = (uint32_t)job->slabs;
    }
    for (int k = 0; k < job->slabs; k++) {
        const int32_t *restrict cell = job->cell[k];
        uint32_t seen[RF_RAY_CHUNK];

        if (k % BITS == 0)
            for (int n = 0; n < rays; n++)
                s.first[k / BITS][n] = s.joined[k / BITS][n] = 0;
        for (int n = 0; n < rays; n++)
            seen[n] = job->range[cell[n]];
        for (int n = 0; job->below && n < rays; n++)
            seen[n] = both(seen[n], job->below[cell[n]]);
        if (!meet_slab(&s, seen, job, k))
            break;
    }
    sorted->rays = rays;
    if (job->weight)
        place_all(sorted, job, &s, true);
    else
        place_all(sorted, job, &s, false);
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
