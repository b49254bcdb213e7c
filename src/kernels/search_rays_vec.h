/* search_rays_vec.h: the template of the searches, which follow rays a vector of pixels at a time.
 *
 * First guesses lie side by side. Mostly they lead all pixels the same way, or, at an edge and on a
 * slope, one of two ways: that of the first pixel and that of the next that goes another. What
 * these are is found out for all rays beforehand, so that nothing waits for it. Both ways are
 * looked up without a branch, and pixels that go other ways yet, or are not settled, come last.
 * Where light counts by its weight, rays that lead all pixels the same way, and settled, are sorted
 * out before: all that is left to do is to add up what they see. Where a ray falls back on the
 * pixel's own light, it is only counted.
 */
#ifndef RF_KERNELS_SEARCH_RAYS_VEC_H
#define RF_KERNELS_SEARCH_RAYS_VEC_H

#include "kernels/search_span_vec.h"

static RF_ALWAYS_INLINE void rf_place_ways(struct rf_ways *ways, const uint16_t *key, int n,
                                           const struct rf_search_job *job, const bool weighted)
{
    const int32_t stride = (int32_t)job->stride, weight_stride = (int32_t)job->weight_stride;

    n = (n + 7) / 8 * 8; /* no remainder */
    for (int i = 0; i < n; i++)
        ways->at[i] = (int8_t)(key[i] & 0xff) + ((int16_t)key[i] >> 8) * stride;
    for (int i = 0; weighted && i < n; i++)
        ways->weight_at[i] = (int8_t)(key[i] & 0xff) + ((int16_t)key[i] >> 8) * weight_stride;
}

/* Finds out the ways of all rays. Those that go one way come first in ray[]; returns how many. */
static RF_ALWAYS_INLINE int rf_aim_span(struct rf_span_rays *r, uint8_t *restrict one_way,
                                        const struct rf_span *s, const bool weighted)
{
    const vec_mask all = vec_mask_all();
    const int rays = s->rays->rays;
    int *restrict const many = r->ray;
    int one = 0, more = 0;

    for (int n = 0; n < rays; n++) {
        const vec_u16 key = rf_key_of(s, n, rf_first_guess(s, n));
        const vec_mask others =
            vec_mask_without(all, vec_mask_equal(all, key, vec_u16_spread(key)));
        const int is_more = !weighted || vec_mask_any(others);

        vec_u16_store(r->keys[n], key);
        r->key[0][n] = vec_u16_lane0(key);
        r->key[1][n] = r->keys[n][vec_mask_first(others)];
        if (weighted)
            one_way[one] = (uint8_t)n;
        if (weighted)
            many[more] = n;
        one += !is_more;
        more += is_more;
    }
    r->count = more;
    return one;
}

/* Sorts out of the rays that go one way those whose first test settles all lanes. */
static RF_ALWAYS_INLINE void rf_find_alike(struct rf_span_rays *r, const uint8_t *one_way, int one,
                                           const struct rf_span *s)
{
    int alike = 0, count = r->count;

    for (int i = 0; i < one; i++) {
        const int n = one_way[i];
        const vec_u16 there = vec_u16_load(s->job->blur + s->at + r->way[0].at[n]);
        const int pending =
            vec_mask_any(rf_unsettled(s, n, vec_mask_all(), rf_first_guess(s, n), there, s->above));

        r->known.at[alike] = r->way[0].at[n];
        r->known.weight_at[alike] = r->way[0].weight_at[n];
        r->ray[count] = n;
        alike += !pending;
        count += pending;
    }
    r->alike = alike;
    r->count = count;
}

/* Sees what ray i of ray[] sees after its first test, two ways. Returns how many rays are left. */
static RF_ALWAYS_INLINE int rf_test_two(struct rf_seen *hit, struct rf_search_sums *sums,
                                        struct rf_search_rest *rest, int left,
                                        const struct rf_span_rays *r, const struct rf_span *s,
                                        int i, const bool weighted, const bool once)
{
    const int n = weighted ? r->ray[i] : i;
    const vec_mask all = vec_mask_all();
    const vec_u16 guess = rf_first_guess(s, n), key = vec_u16_load(r->keys[n]);
    const vec_mask first = vec_mask_equal(all, key, vec_u16_set(r->key[0][n]));
    const vec_mask not_first = vec_mask_without(all, first);
    const vec_mask second = vec_mask_equal(not_first, key, vec_u16_set(r->key[1][n]));
    const vec_mask others = vec_mask_without(not_first, second);
    const ptrdiff_t q0 = r->way[0].at[n], q1 = r->way[1].at[n];
    const vec_u16 seen = vec_u16_choose(first, vec_u16_load(s->job->blur + s->at + q0),
                                        vec_u16_load(s->job->blur + s->at + q1));
    const vec_mask both = vec_mask_or(first, second);
    const vec_mask pending = rf_unsettled(s, n, both, guess, seen, s->above);
    const vec_mask settled = vec_mask_without(both, pending);

    if (!weighted) {
        rf_see_front(hit, s, q0, 0, vec_mask_without(first, pending), false);
        rf_see_front(hit, s, q1, 0, vec_mask_without(second, pending), false);
    }
    for (int c = 0; weighted && c < 3; c++)
        hit->light[c] =
            vec_u16_put_where(settled, hit->light[c],
                              vec_u16_choose(first, rf_light_at(s, c, q0), rf_light_at(s, c, q1)));
    if (weighted)
        hit->weight =
            vec_u16_put_where(settled, hit->weight,
                              vec_u16_choose(first, rf_weight_at(s, r->way[0].weight_at[n]),
                                             rf_weight_at(s, r->way[1].weight_at[n])));
    rest->ray[left] = n;
    rest->others[left] = others;
    if (once) {
        sums->own = vec_u16_add_where(pending, sums->own, vec_u16_set(1));
        return left + vec_mask_any(others);
    }
    rest->pending[left] = pending;
    rest->seen[left] = seen;
    return left + vec_mask_any(vec_mask_or(others, pending));
}

/* One test of the lanes `waiting`, way by way; returns those it does not settle. */
static RF_ALWAYS_INLINE vec_mask rf_test_ways(struct rf_seen *hit, const struct rf_span *s, int n,
                                              vec_mask waiting, vec_u16 guess, vec_u16 *seen,
                                              vec_u16 above, const bool weighted)
{
    const vec_u16 key = rf_key_of(s, n, guess);
    vec_mask pending = vec_mask_without(waiting, waiting);
    uint16_t keys[RF_SEARCH_LANES];

    vec_u16_store(keys, key);
    while (vec_mask_any(waiting)) {
        const uint16_t way = keys[vec_mask_first(waiting)];
        const ptrdiff_t q = rf_key_offset(way, s->job->stride);
        const vec_mask mask = vec_mask_equal(waiting, key, vec_u16_set(way));
        const vec_u16 there = vec_u16_load(s->job->blur + s->at + q);
        const vec_mask left = rf_unsettled(s, n, mask, guess, there, above);

        rf_see_front(hit, s, q, rf_key_offset(way, s->job->weight_stride),
                     vec_mask_without(mask, left), weighted);
        *seen = vec_u16_choose(mask, there, *seen);
        pending = vec_mask_or(pending, left);
        waiting = vec_mask_without(waiting, mask);
    }
    return pending;
}

/* Lanes that are hidden see the mirrored pixel, or the background, way by way. */
static RF_ALWAYS_INLINE void rf_see_hidden(struct rf_seen *hit, const struct rf_span *s, int n,
                                           vec_mask waiting, vec_u16 guess, const bool weighted)
{
    const bool mirrored = s->job->fallback == RF_FALLBACK_MIRRORED;
    const vec_u16 key =
        rf_key_of(s, n, mirrored ? guess : vec_u16_load(s->job->background_blur + s->at));
    uint16_t keys[RF_SEARCH_LANES];

    vec_u16_store(keys, key);
    while (vec_mask_any(waiting)) {
        const uint16_t way = keys[vec_mask_first(waiting)];
        const ptrdiff_t q = rf_key_offset(way, s->job->stride);
        const vec_mask mask = vec_mask_equal(waiting, key, vec_u16_set(way));

        if (mirrored)
            rf_see_front(hit, s, -q, -rf_key_offset(way, s->job->weight_stride), mask, weighted);
        else
            rf_see_background(hit, s, q, mask, weighted);
        waiting = vec_mask_without(waiting, mask);
    }
}

/* Follows lanes of ray i that are left to their ends. */
static RF_ALWAYS_INLINE void rf_test_rest(struct rf_seen *hit, struct rf_search_sums *sums,
                                          const struct rf_search_rest *rest, int i,
                                          const struct rf_span *s, const bool weighted,
                                          const bool once)
{
    const int n = rest->ray[i];
    const vec_u16 any = vec_u16_set(0x8000); /* a blur below all */
    vec_u16 guess = rf_first_guess(s, n), seen = once ? guess : rest->seen[i];
    vec_mask pending = rf_test_ways(hit, s, n, rest->others[i], guess, &seen, s->above, weighted);

    if (!once)
        pending = vec_mask_or(pending, rest->pending[i]);
    for (int k = s->job->tests - 1; !once && k > 0 && vec_mask_any(pending); k--) {
        guess = seen;
        pending = rf_test_ways(hit, s, n, pending, guess, &seen, k == 1 ? s->own : any, weighted);
    }
    if (once || s->job->fallback == RF_FALLBACK_OWN)
        sums->own = vec_u16_add_where(pending, sums->own, vec_u16_set(1));
    else
        rf_see_hidden(hit, s, n, pending, guess, weighted);
}

static RF_ALWAYS_INLINE void rf_test_all_rest(struct rf_search_sums *all,
                                              const struct rf_search_rest *rest,
                                              const struct rf_span *s, const bool weighted,
                                              const bool once)
{
    struct rf_search_sums sums = *all;
    struct rf_seen hit, none;

    rf_see_nothing(&none);
    for (int i = 0; i < rest->rays; i++) {
        rf_see_nothing(&hit);
        rf_test_rest(weighted ? &hit : &sums.plain, &sums, rest, i, s, weighted, once);
        if (weighted)
            rf_add_pair(&sums, &hit, &none);
    }
    *all = sums;
}

/* Empties what light is added up in. */
static RF_ALWAYS_INLINE void rf_clear_search(struct rf_search_sums *sums, const bool weighted)
{
    for (int c = 0; c < 3; c++)
        sums->plain.light[c] = vec_u16_set(0);
    for (int c = 0; weighted && c < 4; c++)
        sums->weighted[c] = vec_u32_zero();
}

static RF_ALWAYS_INLINE void rf_flush_search(struct rf_search_sums *sums, const struct rf_span *s,
                                             const bool weighted)
{
    for (int c = 0; !weighted && c < 3; c++)
        vec_u16_add_to(s->sum[c], sums->plain.light[c]);
    for (int c = 0; weighted && c < 4; c++)
        vec_u32_add_to(s->weighted[c], sums->weighted[c]);
    rf_clear_search(sums, weighted);
}

/* Rays i to end - 1 of those to be looked up both ways. */
static RF_ALWAYS_INLINE void rf_search_both_ways(struct rf_search_sums *all,
                                                 struct rf_search_rest *rest,
                                                 const struct rf_span_rays *r,
                                                 const struct rf_span *s, int i, int end,
                                                 const bool weighted, const bool once)
{
    struct rf_search_sums sums = *all;
    struct rf_seen a, b;
    int left = 0;

    for (; !weighted && i < end; i++)
        left = rf_test_two(&sums.plain, &sums, rest, left, r, s, i, false, once);
    for (; i < end; i += 2) {
        rf_see_nothing(&a);
        rf_see_nothing(&b);
        left = rf_test_two(&a, &sums, rest, left, r, s, i, weighted, once);
        if (i + 1 < end)
            left = rf_test_two(&b, &sums, rest, left, r, s, i + 1, weighted, once);
        rf_add_pair(&sums, &a, &b);
    }
    rest->rays = left;
    *all = sums;
}

static RF_ALWAYS_INLINE void rf_see_known(struct rf_seen *hit, const struct rf_span *s,
                                          const struct rf_ways *known, int i)
{
    for (int c = 0; c < 3; c++)
        hit->light[c] = rf_light_at(s, c, known->at[i]);
    hit->weight = rf_weight_at(s, known->weight_at[i]);
}

/* Rays i to end - 1 of those all of whose light lies one way. */
static RF_ALWAYS_INLINE void rf_add_alike(struct rf_search_sums *all, const struct rf_ways *known,
                                          const struct rf_span *s, int i, int end)
{
    struct rf_search_sums sums = *all;
    struct rf_seen a, b;

    for (; i < end; i += 2) {
        rf_see_known(&a, s, known, i);
        rf_see_nothing(&b);
        if (i + 1 < end)
            rf_see_known(&b, s, known, i + 1);
        rf_add_pair(&sums, &a, &b);
    }
    *all = sums;
}

static RF_ALWAYS_INLINE void rf_add_own(const struct rf_span *s, vec_u16 times, const bool weighted)
{
    uint16_t count[RF_SEARCH_LANES];

    vec_u16_store(count, times);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < RF_SEARCH_LANES; i++) {
            const uint32_t light = (uint32_t)count[i] * s->job->light[c][s->at + i];

            if (weighted)
                s->weighted[c][i] += (uint64_t)light * s->job->weight[s->weight_at + i];
            else
                s->sum[c][i] += light;
        }
    for (int i = 0; weighted && i < RF_SEARCH_LANES; i++)
        s->weighted[3][i] += (uint32_t)count[i] * s->job->weight[s->weight_at + i];
}

static RF_ALWAYS_INLINE int rf_next_group(int i, int steps, int count)
{
    return i + steps < count ? i + steps : count;
}

/* `once`: there is one test, and what is hidden has the pixel's own light. */
static RF_ALWAYS_INLINE void rf_search_span(const struct rf_span *s, struct rf_span_rays *r,
                                            const bool weighted, const bool once)
{
    uint8_t one_way[RF_RAY_CHUNK];
    struct rf_search_sums sums;
    struct rf_search_rest rest;
    int one;

    rf_clear_search(&sums, weighted);
    sums.own = vec_u16_set(0);
    one = rf_aim_span(r, one_way, s, weighted);
    for (int k = 0; k < 2; k++)
        rf_place_ways(&r->way[k], r->key[k], s->rays->rays, s->job, weighted);
    r->alike = 0;
    if (weighted)
        rf_find_alike(r, one_way, one, s);
    for (int i = 0, end; i < r->count; i = end) {
        end = rf_next_group(i, s->job->steps, r->count);
        rf_search_both_ways(&sums, &rest, r, s, i, end, weighted, once);
        rf_test_all_rest(&sums, &rest, s, weighted, once);
        rf_flush_search(&sums, s, weighted);
    }
    for (int i = 0, end; i < r->alike; i = end) {
        end = rf_next_group(i, s->job->steps, r->alike);
        rf_add_alike(&sums, &r->known, s, i, end);
        rf_flush_search(&sums, s, weighted);
    }
    if (vec_u16_any(sums.own))
        rf_add_own(s, sums.own, weighted);
}

static RF_ALWAYS_INLINE void rf_search_strip_vec(uint32_t *const *sum,
                                                 uint64_t *const *weighted_sum,
                                                 const struct rf_search_job *job,
                                                 const bool weighted)
{
    struct rf_span_rays rays;

    for (int i = 0; i < RF_STRIP_LANES; i += RF_SEARCH_LANES) {
        const int x = i % RF_TILE, y = i / RF_TILE;
        struct rf_span span; /* set by hand: clearing it would take as long as a ray */

        span.job = job;
        span.rays = job->rays;
        span.at = y * job->stride + x;
        span.own = vec_u16_load(job->blur + span.at);
        span.above = job->tests == 1 ? span.own : vec_u16_set(0x8000);
        span.weight_at = y * job->weight_stride + x;
        for (int c = 0; c < 4; c++) {
            if (weighted)
                span.weighted[c] = weighted_sum[c] + i;
            else if (c < 3)
                span.sum[c] = sum[c] + i;
        }
        if (job->tests == 1 && job->fallback == RF_FALLBACK_OWN)
            rf_search_span(&span, &rays, weighted, true);
        else
            rf_search_span(&span, &rays, weighted, false);
    }
}

#endif
