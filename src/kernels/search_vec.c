/* search_vec.c: the randomized intersection search, a vector of pixels at a time.
 *
 * First guesses lie side by side. Mostly they lead all pixels the same way; where they do
 * not, pixels that go the same way are taken together. A pixel whose own light is taken is
 * only counted.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum {
    STEPS = 16, /* rays that a 16-bit sum of Q12 light holds */
    LANES = (int)VEC_U16,
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct sums {
    vec_u16 light[3];
    vec_u16 own; /* how often a pixel's own light is added */
};

/* The vector in work: LANES pixels of the tile from `at` elements on. */
struct span {
    const struct rf_search_job *job;
    ptrdiff_t at;
    vec_u16 own; /* blur + 2^15 */
    uint32_t *sum[3];
};

static ALWAYS_INLINE vec_u16 raised(const int16_t *blur)
{
    return vec_u16_xor(vec_u16_load(blur), vec_u16_set(0x8000));
}

/* One test of the lanes of `mask` (`all`: of all), which look `offset` away. Those that are settled are no
 * longer pending; what all see is in *seen. */
static ALWAYS_INLINE void test(struct sums *sums, const struct span *s, uint16_t within,
                               ptrdiff_t offset, vec_u16 guess, vec_u16 mask, const bool all,
                               const bool last, vec_u16 *pending, vec_u16 *seen)
{
    const ptrdiff_t q = s->at + offset;
    const vec_u16 found = raised(s->job->blur + q);
    const vec_u16 apart = vec_u16_sub(vec_u16_max(found, guess), vec_u16_min(found, guess));
    vec_u16 take = vec_u16_at_most(apart, vec_u16_set(within));

    if (last)
        take = vec_u16_or(take, vec_u16_at_most(found, s->own));
    else if (all)
        *seen = found;
    else
        *seen = vec_u16_or(vec_u16_and(found, mask), vec_u16_without(*seen, mask));
    if (!all)
        take = vec_u16_and(take, mask);
    *pending = vec_u16_without(*pending, take);
    for (int c = 0; c < 3; c++)
        sums->light[c] = vec_u16_add(
            sums->light[c], vec_u16_and(vec_u16_load(s->job->light[c] + q), take));
}

/* x in the low byte, y in the high one, both within 127. */
static ALWAYS_INLINE ptrdiff_t offset_from(uint16_t key, ptrdiff_t stride)
{
    return (int8_t)(key >> 8) * stride + (int8_t)(key & 0xff);
}

/* Test what is pending. Guesses are raised; the next are left in *guess. */
static ALWAYS_INLINE void test_all(struct sums *sums, const struct span *s,
                                   const struct rf_search_ray *ray, vec_u16 *guess,
                                   vec_u16 *pending, const bool first, const bool last)
{
    const ptrdiff_t stride = s->job->stride;
    const vec_u16 blur = vec_u16_xor(*guess, vec_u16_set(0x8000)), waiting = *pending;
    const vec_u16 key = vec_u16_bytes(vec_u16_offset(blur, vec_u16_set((uint16_t)ray->u)),
                                      vec_u16_offset(blur, vec_u16_set((uint16_t)ray->v)));
    const uint16_t within = (uint16_t)ray->within;
    vec_u16 seen = *guess, mask;
    uint16_t keys[LANES];
    uint64_t bits;

    if (first) {
        const ptrdiff_t offset = offset_from(vec_u16_lane0(key), stride);

        mask = vec_u16_equal(key, vec_u16_spread(key));
        bits = vec_u16_bits(vec_u16_without(waiting, mask));
        if (!bits)
            test(sums, s, within, offset, *guess, mask, true, last, pending, &seen);
        else
            test(sums, s, within, offset, *guess, mask, false, last, pending, &seen);
    } else {
        bits = vec_u16_bits(waiting);
    }
    if (bits)
        vec_u16_store(keys, key);
    while (bits) {
        const uint16_t next = keys[__builtin_ctzll(bits) / VEC_BITS];

        mask = vec_u16_and(waiting, vec_u16_equal(key, vec_u16_set(next)));
        test(sums, s, within, offset_from(next, stride), *guess, mask, false, last, pending,
             &seen);
        bits &= ~vec_u16_bits(mask);
    }
    *guess = seen;
}

static ALWAYS_INLINE void search_ray(struct sums *sums, const struct span *s,
                                     const struct rf_search_ray *ray, const bool once)
{
    vec_u16 guess = raised(s->job->blur + s->at + ray->start);
    vec_u16 pending = vec_u16_set(0xffff);

    test_all(sums, s, ray, &guess, &pending, true, once);
    if (!once) {
        for (int n = s->job->tests - 1; n > 1 && vec_u16_any(pending); n--)
            test_all(sums, s, ray, &guess, &pending, false, false);
        if (vec_u16_any(pending))
            test_all(sums, s, ray, &guess, &pending, false, true);
    }
    sums->own = vec_u16_sub(sums->own, pending);
}

static ALWAYS_INLINE void clear(struct sums *sums)
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

static ALWAYS_INLINE void search_span(const struct span *s, const bool once)
{
    const int rays = s->job->rays;
    struct sums sums;

    clear(&sums);
    for (int n = 0, end; n < rays; n = end) {
        end = n + STEPS < rays ? n + STEPS : rays;
        for (; n < end; n++)
            search_ray(&sums, s, &s->job->ray[n], once);
        for (int c = 0; c < 3; c++) {
            vec_u16_add_to(s->sum[c], sums.light[c]);
            sums.light[c] = vec_u16_set(0);
        }
    }
    if (vec_u16_any(sums.own))
        add_own(s, sums.own);
}

static void RF_VEC(rf_search)(uint32_t *const sum[3], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i += LANES) {
        const ptrdiff_t at = i / RF_TILE * job->stride + i % RF_TILE;
        const struct span span = {job, at, raised(job->blur + at),
                                  {sum[0] + i, sum[1] + i, sum[2] + i}};

        if (job->tests == 1)
            search_span(&span, true);
        else
            search_span(&span, false);
    }
}

void RF_VEC(rf_search_use)(struct rf_kernels *kernels)
{
    kernels->search = RF_VEC(rf_search);
}
