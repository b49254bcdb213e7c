/* search_vec.c: follows rays by the randomized intersection search, a vector of pixels at a time.
 *
 * First guesses lie side by side. Mostly they lead all pixels the same way, or, at an edge and on a
 * slope, one of two ways: that of the first pixel and that of the next that goes another. Both are
 * looked up without a branch, and what they are is found out for all rays beforehand, so that
 * nothing waits for it. Pixels that go other ways yet come last. Where a ray falls back on the
 * pixel's own light, it is only counted.
 */
#include "colour/transfer.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <assert.h>

enum {
    STEPS = 16, /* rays that a 16-bit sum of Q12 light holds */
    LANES = (int)VEC_U16,
};
static_assert(STEPS * RF_LIGHT_MAX <= UINT16_MAX, "a sum of light fits 16 bits");

struct sums {
    vec_u16 light[3];
    vec_u16 own; /* how often a pixel's own light is added */
};

/* The vector in work: LANES pixels of the tile from `at` elements on. */
struct span {
    const struct rf_search_job *job;
    const struct rf_search_rays *rays;
    ptrdiff_t at;
    vec_u16 own; /* blur */
    uint32_t *sum[3];
};

/* All rays of a span: where lanes look, and of that what lane 0 does, and the first
 * lane that does not do the same. */
struct aims {
    uint16_t keys[RF_RAY_CHUNK][LANES]; /* see offset_from() */
    uint16_t key[2][RF_RAY_CHUNK];
    int32_t at[2][RF_RAY_CHUNK];
};

/* Some of them, that leave lanes which look elsewhere, or test again. */
struct rest {
    int rays, ray[STEPS];
    vec_mask others[STEPS], pending[STEPS];
    vec_u16 seen[STEPS]; /* blurs that the rays which test again have seen */
};

/* x in the low byte, y in the high one, both within 127. */
static RF_ALWAYS_INLINE ptrdiff_t offset_from(uint16_t key, ptrdiff_t stride)
{
    return (int8_t)(key >> 8) * stride + (int8_t)(key & 0xff);
}

static RF_ALWAYS_INLINE vec_u16 key_of(const struct span *s, int n, vec_u16 guess)
{
    return vec_u16_bytes(vec_u16_offset(guess, vec_u16_set((uint16_t)s->rays->u[n])),
                         vec_u16_offset(guess, vec_u16_set((uint16_t)s->rays->v[n])));
}

static RF_ALWAYS_INLINE vec_u16 first_guess(const struct span *s, int n)
{
    return vec_u16_load(s->job->blur + s->at + s->rays->start[n]);
}

/* The lanes of `mask` that what they see does not settle. */
static RF_ALWAYS_INLINE vec_mask unsettled(const struct span *s, int n, vec_mask mask,
                                           vec_u16 guess, vec_u16 seen, const bool last)
{
    const vec_u16 within = vec_u16_set((uint16_t)s->rays->within[n]);

    if (last)
        mask = vec_mask_less(mask, s->own, seen);
    return vec_mask_less(mask, within, vec_s16_apart(seen, guess));
}

static RF_ALWAYS_INLINE void add_light(struct sums *sums, const struct span *s, ptrdiff_t q,
                                       vec_mask mask)
{
    for (int c = 0; c < 3; c++)
        sums->light[c] =
            vec_u16_add_where(mask, sums->light[c], vec_u16_load(s->job->light[c] + q));
}

static RF_ALWAYS_INLINE void add_to_own(struct sums *sums, vec_mask mask)
{
    sums->own = vec_u16_add_where(mask, sums->own, vec_u16_set(1));
}

static RF_ALWAYS_INLINE void aim(struct aims *aims, const struct span *s)
{
    const vec_mask all = vec_mask_all();
    const int32_t stride = (int32_t)s->job->stride;
    const int rays = s->rays->rays;

    for (int n = 0; n < rays; n++) {
        const vec_u16 key = key_of(s, n, first_guess(s, n));
        const vec_mask others =
            vec_mask_without(all, vec_mask_equal(all, key, vec_u16_spread(key)));

        vec_u16_store(aims->keys[n], key);
        aims->key[0][n] = vec_u16_lane0(key);
        aims->key[1][n] = aims->keys[n][vec_mask_first(others)];
    }
    for (int k = 0; k < 2; k++)
        for (int n = 0; n < (rays + 7) / 8 * 8; n++) /* no remainder */
            aims->at[k][n] =
                (int8_t)(aims->key[k][n] & 0xff) + ((int16_t)aims->key[k][n] >> 8) * stride;
}

/* The first test of rays n to end, two ways. */
static RF_ALWAYS_INLINE void test_two(struct sums *sums, struct rest *rest, const struct aims *aims,
                                      const struct span *s, int n, int end, const bool once)
{
    const vec_mask all = vec_mask_all();
    int left = 0;

    for (; n < end; n++) {
        const vec_u16 guess = first_guess(s, n), key = vec_u16_load(aims->keys[n]);
        const vec_mask first = vec_mask_equal(all, key, vec_u16_set(aims->key[0][n]));
        const vec_mask not_first = vec_mask_without(all, first);
        const vec_mask second = vec_mask_equal(not_first, key, vec_u16_set(aims->key[1][n]));
        const vec_mask others = vec_mask_without(not_first, second);
        const ptrdiff_t q0 = s->at + aims->at[0][n], q1 = s->at + aims->at[1][n];
        const vec_u16 seen =
            vec_u16_choose(first, vec_u16_load(s->job->blur + q0), vec_u16_load(s->job->blur + q1));
        const vec_mask pending = unsettled(s, n, vec_mask_or(first, second), guess, seen, once);

        add_light(sums, s, q0, vec_mask_without(first, pending));
        add_light(sums, s, q1, vec_mask_without(second, pending));
        rest->ray[left] = n;
        rest->others[left] = others;
        if (once) {
            add_to_own(sums, pending);
            left += vec_mask_any(others);
        } else {
            rest->pending[left] = pending;
            rest->seen[left] = seen;
            left += vec_mask_any(vec_mask_or(others, pending));
        }
    }
    rest->rays = left;
}

/* One test of the lanes `waiting`, way by way; returns those it does not settle. */
static RF_ALWAYS_INLINE vec_mask test_ways(struct sums *sums, const struct span *s, int n,
                                           vec_mask waiting, vec_u16 guess, vec_u16 *seen,
                                           const bool last)
{
    const vec_u16 key = key_of(s, n, guess);
    vec_mask pending = vec_mask_without(waiting, waiting);
    uint16_t keys[LANES];

    vec_u16_store(keys, key);
    while (vec_mask_any(waiting)) {
        const uint16_t way = keys[vec_mask_first(waiting)];
        const ptrdiff_t q = s->at + offset_from(way, s->job->stride);
        const vec_mask mask = vec_mask_equal(waiting, key, vec_u16_set(way));
        const vec_u16 there = vec_u16_load(s->job->blur + q);
        const vec_mask left = unsettled(s, n, mask, guess, there, last);

        add_light(sums, s, q, vec_mask_without(mask, left));
        *seen = vec_u16_choose(mask, there, *seen);
        pending = vec_mask_or(pending, left);
        waiting = vec_mask_without(waiting, mask);
    }
    return pending;
}

static RF_ALWAYS_INLINE void test_rest(struct sums *sums, const struct rest *rest, int i,
                                       const struct span *s, const bool once)
{
    const int n = rest->ray[i];
    const vec_u16 guess = first_guess(s, n);
    vec_u16 seen = once ? guess : rest->seen[i];
    vec_mask pending = test_ways(sums, s, n, rest->others[i], guess, &seen, once);

    if (!once)
        pending = vec_mask_or(pending, rest->pending[i]);
    for (int k = s->job->tests - 1; !once && k > 0 && vec_mask_any(pending); k--)
        pending = test_ways(sums, s, n, pending, seen, &seen, k == 1);
    add_to_own(sums, pending);
}

static RF_ALWAYS_INLINE void clear(struct sums *sums)
{
    const vec_u16 zero = vec_u16_set(0);

    *sums = (struct sums){{zero, zero, zero}, zero};
}

static void add_own(const struct span *s, vec_u16 times)
{
    uint16_t count[LANES];

    vec_u16_store(count, times);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] += (uint32_t)count[i] * s->job->light[c][s->at + i];
}

static RF_ALWAYS_INLINE void search_span(const struct span *s, const bool once)
{
    const int rays = s->rays->rays;
    struct aims aims;
    struct rest rest;
    struct sums sums;

    clear(&sums);
    aim(&aims, s);
    for (int n = 0; n < rays; n += STEPS) {
        test_two(&sums, &rest, &aims, s, n, n + STEPS < rays ? n + STEPS : rays, once);
        for (int i = 0; i < rest.rays; i++)
            test_rest(&sums, &rest, i, s, once);
        for (int c = 0; c < 3; c++) {
            vec_u16_add_to(s->sum[c], sums.light[c]);
            sums.light[c] = vec_u16_set(0);
        }
    }
    if (vec_u16_any(sums.own))
        add_own(s, sums.own);
}

void RF_VEC(rf_search)(uint32_t *const sum[3], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i += LANES) {
        const ptrdiff_t at = i / RF_TILE * job->stride + i % RF_TILE;
        const struct span span = {
            job, job->rays, at, vec_u16_load(job->blur + at), {sum[0] + i, sum[1] + i, sum[2] + i}};

        if (job->tests == 1)
            search_span(&span, true);
        else
            search_span(&span, false);
    }
}
