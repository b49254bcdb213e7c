/* search_span_vec.h: a vector of pixels whose rays are searched, and the light that they see; the
 * loops are in search_rays_vec.h. */
#ifndef RF_KERNELS_SEARCH_SPAN_VEC_H
#define RF_KERNELS_SEARCH_SPAN_VEC_H

#include "colour/transfer.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { RF_SEARCH_LANES = (int)VEC_U16, RF_SEARCH_STEPS = 32 /* at most */ };

/* Light that one ray of each lane sees, and its weight; 0 where it sees nothing yet. */
struct rf_seen {
    vec_u16 light[3], weight;
};

/* Sums of light, in 16 bits, or of light times weight and of weights, in 32 bits. */
struct rf_search_sums {
    struct rf_seen plain;
    vec_u32 weighted[4];
    vec_u16 own; /* the number of times that a pixel's own light is added */
};

/* The vector in work: pixels of the strip from `at` elements on, of weights from `weight_at` on. */
struct rf_span {
    const struct rf_search_job *job;
    const struct rf_search_rays *rays;
    ptrdiff_t at, weight_at;
    vec_u16 own;   /* blur */
    vec_u16 above; /* the first test fails only where it sees more */
    uint32_t *sum[3];
    uint64_t *weighted[4];
};

/* Where light lies, and its weight: elements from the span. */
struct rf_ways {
    int32_t at[RF_RAY_CHUNK], weight_at[RF_RAY_CHUNK];
};

/* The rays of a span: where lanes look, and of that what lane 0 does, and the first lane that
 * does not do the same. */
struct rf_span_rays {
    uint16_t keys[RF_RAY_CHUNK][RF_SEARCH_LANES]; /* x in the low byte, y in the high one */
    uint16_t key[2][RF_RAY_CHUNK];
    struct rf_ways way[2];
    int ray[RF_RAY_CHUNK], count; /* rays to be looked up both ways */
    int alike;                    /* rays all of whose light lies one way */
    struct rf_ways known;         /* ways of these */
};

/* Some of them, that leave lanes which look elsewhere, or test again. */
struct rf_search_rest {
    int rays, ray[RF_SEARCH_STEPS];
    vec_mask others[RF_SEARCH_STEPS], pending[RF_SEARCH_STEPS];
    vec_u16 seen[RF_SEARCH_STEPS]; /* blurs that the rays which test again have seen */
};

static RF_ALWAYS_INLINE ptrdiff_t rf_key_offset(uint16_t key, ptrdiff_t stride)
{
    return (int8_t)(key >> 8) * stride + (int8_t)(key & 0xff);
}

static RF_ALWAYS_INLINE vec_u16 rf_key_of(const struct rf_span *s, int n, vec_u16 guess)
{
    return vec_u16_bytes(vec_u16_offset(guess, vec_u16_set((uint16_t)s->rays->u[n])),
                         vec_u16_offset(guess, vec_u16_set((uint16_t)s->rays->v[n])));
}

static RF_ALWAYS_INLINE vec_u16 rf_first_guess(const struct rf_span *s, int n)
{
    return vec_u16_load(s->job->blur + s->at + s->rays->start[n]);
}

/* The lanes of `mask` that what they see does not settle, if it is above that. */
static RF_ALWAYS_INLINE vec_mask rf_unsettled(const struct rf_span *s, int n, vec_mask mask,
                                              vec_u16 guess, vec_u16 seen, vec_u16 above)
{
    const vec_u16 within = vec_u16_set((uint16_t)s->rays->within[n]);

    mask = vec_mask_less(mask, above, seen);
    return vec_mask_less(mask, within, vec_s16_apart(seen, guess));
}

static RF_ALWAYS_INLINE vec_u16 rf_light_at(const struct rf_span *s, int c, ptrdiff_t q)
{
    return vec_u16_load(s->job->light[c] + s->at + q);
}

static RF_ALWAYS_INLINE vec_u16 rf_weight_at(const struct rf_span *s, ptrdiff_t q)
{
    return vec_u16_load(s->job->weight + s->weight_at + q);
}

/* Adds the light that rays a and b see, times its weight. */
static RF_ALWAYS_INLINE void rf_add_pair(struct rf_search_sums *sums, const struct rf_seen *a,
                                         const struct rf_seen *b)
{
    const vec_u16 one = vec_u16_set(1);

    for (int c = 0; c < 3; c++)
        sums->weighted[c] =
            vec_u32_add_products(sums->weighted[c], a->light[c], a->weight, b->light[c], b->weight);
    sums->weighted[3] = vec_u32_add_products(sums->weighted[3], a->weight, one, b->weight, one);
}

static RF_ALWAYS_INLINE void rf_see_nothing(struct rf_seen *seen)
{
    const vec_u16 zero = vec_u16_set(0);

    *seen = (struct rf_seen){{zero, zero, zero}, zero};
}

/* Light of one more ray: plain light is added up at once, other light waits for its weight. */
static RF_ALWAYS_INLINE void rf_see(struct rf_seen *seen, int c, vec_u16 light, vec_mask mask,
                                    const bool weighted)
{
    seen->light[c] = weighted ? vec_u16_put_where(mask, seen->light[c], light)
                              : vec_u16_add_where(mask, seen->light[c], light);
}

/* Sees the light of the span's pixels at an offset, where `mask` is on. */
static RF_ALWAYS_INLINE void rf_see_front(struct rf_seen *seen, const struct rf_span *s,
                                          ptrdiff_t q, ptrdiff_t weight_q, vec_mask mask,
                                          const bool weighted)
{
    for (int c = 0; c < 3; c++)
        rf_see(seen, c, rf_light_at(s, c, q), mask, weighted);
    if (weighted)
        seen->weight = vec_u16_put_where(mask, seen->weight, rf_weight_at(s, weight_q));
}

/* Sees that of the background, whose weights are looked up. */
static RF_ALWAYS_INLINE void rf_see_background(struct rf_seen *seen, const struct rf_span *s,
                                               ptrdiff_t q, vec_mask mask, const bool weighted)
{
    vec_u16 most = vec_u16_set(0);
    uint16_t weight[RF_SEARCH_LANES];

    for (int c = 0; c < 3; c++) {
        const vec_u16 light = vec_u16_load(s->job->background[c] + s->at + q);

        if (c == 0 || !s->job->first_weighs)
            most = vec_u16_max(most, light);
        rf_see(seen, c, light, mask, weighted);
    }
    if (!weighted)
        return;
    vec_u16_store(weight, vec_u16_min(most, vec_u16_set(RF_LIGHT_MAX)));
    for (int i = 0; i < RF_SEARCH_LANES; i++)
        weight[i] = s->job->light_weight[weight[i]];
    seen->weight = vec_u16_put_where(mask, seen->weight, vec_u16_load(weight));
}

#endif
