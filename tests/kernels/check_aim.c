/* check_aim.c: checks the kernels that aim rays at light, against their contracts' words, one
 * element at a time. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_BLUR = 127 * 256,
    SIDE = 9, /* side of the ranges that rays may see */
    MOST_SLABS = 72,
};

static int blur_noise(uint32_t *seed, int kind)
{
    const int any = noise_between(seed, -MOST_BLUR, MOST_BLUR);

    return kind == 0 ? any : kind == 1 ? (any < 0 ? -MOST_BLUR : MOST_BLUR) : any / 64;
}

static bool fail(const struct subject *subject, const char *what, uint32_t seed, int n, int at,
                 long is, long should)
{
    printf("FAIL  %-12s %-6s seed %u, n = %d: element %d is %ld, should be %ld\n", what,
           subject->cpu, (unsigned)seed, n, at, is, should);
    return false;
}

/* floor(a / b) for b > 0. */
static int floor_of(int64_t a, int64_t b)
{
    return (int)(a >= 0 ? a / b : -((-a + b - 1) / b));
}

static bool check_aim_at(const struct subject *subject, int n, uint32_t seed)
{
    const uint32_t first = seed;
    const int stride = noise_between(&seed, 100, 70000), cells = noise_between(&seed, 9, 9000);
    const int blur = blur_noise(&seed, (int)(first % 3)), unit = (int)(first / 3 % 4);
    const int shift = 23 - unit;
    int16_t u[RF_RAY_CHUNK] = {0}, v[RF_RAY_CHUNK] = {0};
    int32_t offset[RF_RAY_CHUNK], cell[RF_RAY_CHUNK];

    for (int i = 0; i < n; i++) {
        u[i] = (int16_t)(i < 4 ? (i % 2 ? 32767 : -32767) : noise_between(&seed, -32767, 32767));
        v[i] = (int16_t)(i < 4 ? (i / 2 ? 32767 : -32767) : noise_between(&seed, -32767, 32767));
    }
    subject->kernels.aim(offset, cell, u, v, blur, unit, stride, cells, n);
    for (int i = 0; i < n; i++) {
        const int x = floor_of((int64_t)u[i] * blur + (1 << (shift - 1)), 1 << shift);
        const int y = floor_of((int64_t)v[i] * blur + (1 << (shift - 1)), 1 << shift);

        if (offset[i] != x + y * stride)
            return fail(subject, "aim", first, n, i, offset[i], x + y * stride);
        if (cell[i] != floor_of(x, RF_CELL) + floor_of(y, RF_CELL) * cells)
            return fail(subject, "aim", first, n, i, cell[i],
                        floor_of(x, RF_CELL) + floor_of(y, RF_CELL) * cells);
    }
    return true;
}

struct view {
    uint32_t range[SIDE * SIDE], below[SIDE * SIDE];
    uint16_t front[1000], background[1000];
    struct rf_slab slab[MOST_SLABS];
    bool joined[MOST_SLABS];
    int32_t offset[MOST_SLABS + 1][RF_RAY_CHUNK], cell[MOST_SLABS][RF_RAY_CHUNK];
    uint16_t chroma_front[1000], chroma_background[1000];
    int32_t chroma_offset[MOST_SLABS + 1][RF_RAY_CHUNK];
    uint16_t weight[1000], background_weight[1000];
    int32_t chroma_weight_offset[MOST_SLABS + 1][RF_RAY_CHUNK];
    struct rf_sort_job job;
    struct rf_sorted_rays sorted, expected;
};

static void make_view(struct view *s, int n, uint32_t seed)
{
    const int slabs = noise(&seed) % 8 ? noise_between(&seed, 0, 8) : MOST_SLABS;
    const int spread = noise_between(&seed, 0, 900);

    for (int i = 0; i < SIDE * SIDE; i++) {
        const int low = noise_between(&seed, 0, slabs) * 256 - 3000;
        const int high = low + noise_between(&seed, 0, spread);

        s->range[i] = (uint32_t)(low & 0xffff) | (uint32_t)(high & ~1) << 16 |
                      (noise(&seed) % 2 ? RF_IN_BACKGROUND : 0);
        s->below[i] = s->range[noise_between(&seed, 0, i)];
    }
    for (int k = 0; k <= slabs; k++) {
        for (int i = 0; i < n; i++) {
            const bool same = k > 0 && noise(&seed) % 2; /* the slab before has this offset, too */

            s->offset[k][i] = same ? s->offset[k - 1][i] : noise_between(&seed, 0, 999);
            s->chroma_offset[k][i] = noise_between(&seed, 0, 999);
            s->chroma_weight_offset[k][i] = noise_between(&seed, 0, 999);
            if (k < slabs)
                s->cell[k][i] = same ? s->cell[k - 1][i] : noise_between(&seed, 0, SIDE * SIDE - 1);
        }
        if (k < slabs) {
            s->slab[k] = (struct rf_slab){(int16_t)(k * 256 - 3000 - (int)(noise(&seed) % 3)),
                                          (uint16_t)noise_between(&seed, 0, 479), 0};
            s->joined[k] = k > 0 && noise(&seed) % 4 &&
                           s->slab[k].low <= s->slab[k - 1].low + s->slab[k - 1].width + 1;
        }
    }
    s->job = (struct rf_sort_job){
        .range = s->range,
        .below = seed % 4 == 1 ? s->below : NULL,
        .skip_deepest = seed % 8 < 5,
        .front = s->front,
        .background = s->background,
        .rays = n,
        .slabs = slabs,
        .slab = s->slab,
        .joined = s->joined,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])s->offset,
        .cell = (const int32_t(*)[RF_RAY_CHUNK])s->cell,
        .shared = seed % 3 ? noise_between(&seed, 0, n) : 0,
        .weight = seed % 5 < 2 ? s->weight : NULL,
        .background_weight = s->background_weight,
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])s->chroma_offset, /* any */
        .chroma_weight_offset = (const int32_t(*)[RF_RAY_CHUNK])s->chroma_weight_offset,
        .chroma_offset = (const int32_t(*)[RF_RAY_CHUNK])s->chroma_offset,
        .chroma_front = s->chroma_front,
        .chroma_background = s->chroma_background,
    };
}

/* Expects ray n, the m-th, to see last what lies in slab k, or the hidden background there. */
static void expect_last(struct view *s, int n, int m, int k, bool is_background)
{
    const uint16_t *weight = is_background ? s->background_weight : s->weight;

    s->expected.last[m] = (is_background ? s->background : s->front) + s->offset[k][n];
    s->expected.chroma_last[m] =
        (is_background ? s->chroma_background : s->chroma_front) + s->chroma_offset[k][n];
    s->expected.last_weight[m] =
        weight + (is_background ? s->offset[k][n] : s->chroma_offset[k][n]);
    s->expected.last_is_background[m] = is_background;
    s->expected.chroma_last_weight[m] = weight + s->chroma_weight_offset[k][n];
}

/* Bounds of the light where ray n sees slab k. */
struct seen {
    int low, high;
    bool in_background;
};

static struct seen seen_by(const struct view *s, int k, int n)
{
    const uint32_t *const in[2] = {s->range, s->job.below};
    struct seen seen = {INT16_MAX, INT16_MIN, true};

    for (int i = 0; i < 2 && in[i]; i++) {
        const uint32_t range = in[i][s->cell[k][n]];
        const int low = rf_range_least(range), high = rf_range_most(range);

        seen.low = low < seen.low ? low : seen.low;
        seen.high = high > seen.high ? high : seen.high;
        seen.in_background = seen.in_background && range & RF_IN_BACKGROUND;
    }
    return seen;
}

/* The least rf_background_depth() of blurs from low to high. */
static int depth_in(int low, int high)
{
    int least = INT16_MAX;

    for (int blur = low; blur <= high; blur++) {
        const int depth = abs(blur) / 8 + abs(blur) / 32 - 256;

        least = depth < least ? depth : least;
    }
    return least < 320 ? 320 : least;
}

/* Ray n of the job becomes the m-th if it has as many tests as `wanted`, or more where
 * that is the last class. Returns whether. */
static bool expect_ray(struct view *s, int n, int m, int wanted)
{
    int tests = 0, before = -1, start = 0; /* the last slab that is tested */
    bool past_slabs = true;

    expect_last(s, n, m, s->job.slabs, true);
    for (int k = 0; k < s->job.slabs; k++) {
        const struct seen seen = seen_by(s, k, n);
        const int from = s->slab[k].low, to = from + s->slab[k].width;
        bool beside;

        if (seen.high < from || seen.low > to)
            continue;
        beside =
            before == k - 1 && k % RF_JOIN_BLOCK && k > 0 && s->offset[k][n] == s->offset[k - 1][n];
        if (seen.low >= from && seen.high <= to) {
            expect_last(s, n, m, k, false);
            tests -= beside;
            past_slabs = false;
            break;
        }
        if (s->job.skip_deepest && seen.in_background && seen.high <= to &&
            to - from <= depth_in(from, to)) {
            expect_last(s, n, m, k, true);
            past_slabs = false;
            break;
        }
        if (!beside || !s->joined[k]) {
            s->expected.chroma_offset[tests][m] = s->chroma_offset[k][n];
            s->expected.weight_offset[tests][m] = s->chroma_offset[k][n];
            s->expected.chroma_weight_offset[tests][m] = s->chroma_weight_offset[k][n];
            s->expected.offset[tests++][m] = s->offset[k][n];
            start = k;
        }
        s->expected.from[tests - 1][m] = rf_range_from(&s->slab[start]);
        s->expected.to[tests - 1][m] = rf_range_to(&s->slab[start], &s->slab[k]);
        before = k;
    }
    s->expected.tests[m] = (uint8_t)tests;
    s->expected.past_slabs = s->expected.past_slabs || past_slabs;
    return tests == wanted || (wanted == RF_SORTED_TESTS - 1 && tests > wanted);
}

/* Rays that chroma shares: of each class those of the job's first ones. */
static bool check_shared(const struct subject *subject, const struct view *s, int class, int n,
                         uint32_t seed)
{
    const struct rf_sorted_rays *is = &s->sorted, *should = &s->expected;

    if (is->begin[class] != should->begin[class])
        return fail(subject, "sort_rays", seed, n, class, is->begin[class], should->begin[class]);
    if (is->shared[class] != should->shared[class])
        return fail(subject, "sort_rays", seed, n, class, is->shared[class], should->shared[class]);
    for (int i = is->begin[class]; i < is->begin[class] + is->shared[class]; i++) {
        if (is->chroma_last[i] != should->chroma_last[i])
            return fail(subject, "sort_rays", seed, n, i, is->chroma_last[i] - s->chroma_front,
                        should->chroma_last[i] - s->chroma_front);
        if (s->job.weight && is->chroma_last_weight[i] != should->chroma_last_weight[i])
            return fail(subject, "sort_rays", seed, n, i, is->chroma_last_weight[i] - s->weight,
                        should->chroma_last_weight[i] - s->weight);
        for (int t = 0; t < is->tests[i]; t++)
            if (is->chroma_offset[t][i] != should->chroma_offset[t][i] ||
                (s->job.weight &&
                 is->chroma_weight_offset[t][i] != should->chroma_weight_offset[t][i]))
                return fail(subject, "sort_rays", seed, n, i, is->chroma_offset[t][i],
                            should->chroma_offset[t][i]);
    }
    return true;
}

static bool check_weights(const struct subject *subject, const struct view *s, int n, uint32_t seed)
{
    const struct rf_sorted_rays *is = &s->sorted, *should = &s->expected;

    for (int i = 0; s->job.weight && i < n; i++) {
        if (is->last_weight[i] != should->last_weight[i] ||
            is->last_is_background[i] != should->last_is_background[i])
            return fail(subject, "sort_rays", seed, n, i, is->last_weight[i] - s->weight,
                        should->last_weight[i] - s->weight);
        for (int t = 0; t < is->tests[i]; t++)
            if (is->weight_offset[t][i] != should->weight_offset[t][i])
                return fail(subject, "sort_rays", seed, n, i, is->weight_offset[t][i],
                            should->weight_offset[t][i]);
    }
    return true;
}

static bool check_sort(const struct subject *subject, struct view *s, int n, uint32_t seed)
{
    int m = 0;

    make_view(s, n, seed);
    s->expected.past_slabs = false;
    for (int wanted = 0; wanted < RF_SORTED_TESTS; wanted++) {
        s->expected.begin[wanted] = (uint8_t)m;
        s->expected.shared[wanted] = 0;
        for (int i = 0; i < n; i++) {
            const bool is_next = m < n && expect_ray(s, i, m, wanted);

            s->expected.shared[wanted] += is_next && i < s->job.shared;
            m += is_next;
        }
    }
    subject->kernels.sort_rays(&s->sorted, &s->job);
    if (s->sorted.rays != n)
        return fail(subject, "sort_rays", seed, n, -1, s->sorted.rays, n);
    if (s->sorted.past_slabs != s->expected.past_slabs)
        return fail(subject, "sort_rays", seed, n, -1, s->sorted.past_slabs,
                    s->expected.past_slabs);
    for (int i = 0; i < n; i++) {
        if (s->sorted.tests[i] != s->expected.tests[i])
            return fail(subject, "sort_rays", seed, n, i, s->sorted.tests[i], s->expected.tests[i]);
        if (s->sorted.last[i] != s->expected.last[i])
            return fail(subject, "sort_rays", seed, n, i, (long)(s->sorted.last[i] - s->front),
                        (long)(s->expected.last[i] - s->front));
        for (int t = 0; t < s->sorted.tests[i]; t++)
            if (s->sorted.from[t][i] != s->expected.from[t][i] ||
                s->sorted.to[t][i] != s->expected.to[t][i] ||
                s->sorted.offset[t][i] != s->expected.offset[t][i])
                return fail(subject, "sort_rays", seed, n, i, s->sorted.from[t][i],
                            s->expected.from[t][i]);
    }
    for (int class = 0; class < RF_SORTED_TESTS; class ++)
        if (!check_shared(subject, s, class, n, seed))
            return false;
    return check_weights(subject, s, n, seed);
}

static bool check_tolerances(const struct subject *subject, int n, uint32_t seed)
{
    const uint32_t first = seed;
    int16_t u[RF_RAY_CHUNK] = {0}, v[RF_RAY_CHUNK] = {0};
    int32_t within[RF_RAY_CHUNK];

    for (int i = 0; i < n; i++) { /* long rays, and short ones */
        const int most = i % 2 ? 32767 : noise_between(&seed, 0, 200);

        u[i] = (int16_t)noise_between(&seed, -most, most);
        v[i] = (int16_t)(i % 3 ? noise_between(&seed, -most, most) : 0);
    }
    subject->kernels.tolerances(within, u, v, n);
    for (int i = 0; i < n; i++) {
        const uint64_t square = (uint64_t)((int64_t)u[i] * u[i] + (int64_t)v[i] * v[i]);
        uint64_t w = 0;

        for (uint64_t bit = 1 << 15; bit; bit /= 2) /* the largest with w |u| <= 2^22 */
            if ((w + bit) * (w + bit) * square <= UINT64_C(1) << 44)
                w += bit;
        w = w < 32766 ? w : 32766;
        if ((uint64_t)within[i] != w)
            return fail(subject, "tolerances", first, n, i, within[i], (long)w);
    }
    return true;
}

/* Ranges lie all around the strip; rays reach them all. */
static bool check_settle(const struct subject *subject, int n, uint32_t seed)
{
    enum { REACH = 32, CELLS = 2 * REACH + 1 };
    static uint32_t range[CELLS * CELLS];
    const uint32_t first = seed, *const middle = range + REACH * (CELLS + 1);
    const int spread = noise_between(&seed, 0, 300), base = noise_between(&seed, -120, 120);
    const int tests = noise_between(&seed, 1, 3);
    struct rf_search_rays rays = {.rays = n};
    int32_t start[RF_RAY_CHUNK] = {0}, offset[RF_RAY_CHUNK];
    uint8_t settled[RF_RAY_CHUNK];

    for (int i = 0; i < CELLS * CELLS; i++) {
        const int low = base * 256 + noise_between(&seed, -spread, spread);
        const int high = low + noise_between(&seed, 0, spread / 2);

        range[i] = (uint32_t)(low & 0xffff) | (uint32_t)(high & ~1) << 16 |
                   (noise(&seed) % 2 ? RF_IN_BACKGROUND : 0);
    }
    for (int i = 0; i < n; i++) {
        rays.u[i] = (int16_t)noise_between(&seed, -32767, 32767);
        rays.v[i] = (int16_t)noise_between(&seed, -32767, 32767);
        rays.within[i] = noise_between(&seed, 0, 900);
        start[i] =
            noise_between(&seed, -REACH, REACH) * CELLS + noise_between(&seed, -REACH, REACH);
    }
    subject->kernels.settle(settled, offset, middle, start, &rays, tests, 1000, CELLS);
    for (int i = 0; i < n; i++) {
        const int low = rf_range_least(middle[start[i]]), high = rf_range_most(middle[start[i]]);
        const int x = floor_of((int64_t)rays.u[i] * low + (1 << 22), 1 << 23);
        const int y = floor_of((int64_t)rays.v[i] * low + (1 << 22), 1 << 23);
        const bool same = x == floor_of((int64_t)rays.u[i] * high + (1 << 22), 1 << 23) &&
                          y == floor_of((int64_t)rays.v[i] * high + (1 << 22), 1 << 23);
        const uint32_t there = middle[floor_of(y, RF_CELL) * CELLS + floor_of(x, RF_CELL)];
        const int most = rf_range_most(there), own = rf_range_least(*middle);
        const bool confirmed =
            most - low <= rays.within[i] && high - rf_range_least(there) <= rays.within[i];
        const bool good = same && (confirmed || (tests == 1 && most <= own));

        if (settled[i] != good)
            return fail(subject, "settle", first, n, i, settled[i], good);
        if (good && offset[i] != x + 1000 * y)
            return fail(subject, "settle", first, n, i, offset[i], x + 1000 * y);
    }
    return true;
}

int check_aim(const struct subject *subject)
{
    static struct view view;
    uint32_t seed = 1;
    bool good = true;

    for (; good && seed <= 600; seed++) {
        const int n = (int)seed % (RF_RAY_CHUNK + 1);

        good = check_tolerances(subject, n, seed) && check_settle(subject, n, seed) &&
               check_aim_at(subject, n, seed) && check_sort(subject, &view, n, seed);
    }
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "aim", subject->cpu, (int)seed - 1);
    return !good;
}
