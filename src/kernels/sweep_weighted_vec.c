/* sweep_weighted_vec.c: the sweep with weights, one vector at a time, two rays at once. */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

enum {
    STEPS = 32, /* rays that a 32-bit sum holds: 32 * 4095 * 32767 < 2^32 */
};

/* Rays that it holds of light 4 and 8 times as bright. Products of two are added signed:
 * 2 * 8 * 4095 * 32767 < 2^31. */
static const uint8_t steps_of[] = {
    [RF_WHITE] = STEPS, [RF_BRIGHT] = STEPS / 4, [RF_BRIGHTER] = STEPS / 8};

#define ALWAYS_INLINE inline __attribute__((always_inline))

/* What one ray of each lane meets: light and weight. */
struct met {
    vec_u16 light[3], weight;
};

static ALWAYS_INLINE vec_u16 load(const void *base, ptrdiff_t bytes)
{
    return vec_u16_load((const char *)base + bytes);
}

static ALWAYS_INLINE void take(struct met *met, vec_u16 red, vec_u16 green, vec_u16 blue,
                               vec_u16 weight, vec_mask where)
{
    met->light[0] = vec_u16_put_where(where, met->light[0], red);
    met->light[1] = vec_u16_put_where(where, met->light[1], green);
    met->light[2] = vec_u16_put_where(where, met->light[2], blue);
    met->weight = vec_u16_put_where(where, met->weight, weight);
}

/* Where a vector lies: pixel (x, y) of the strip, in bytes of the planes. */
struct place {
    ptrdiff_t at, weight_at;
};

static ALWAYS_INLINE struct place place_of(const struct rf_sweep_job *job, int i)
{
    const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;

    return (struct place){2 * (y * job->stride + x), 2 * (y * job->weight_stride + x)};
}

static ALWAYS_INLINE struct met follow(const struct rf_sweep_job *job, struct place p, int n)
{
    const struct rf_sorted_rays *rays = job->rays;
    const ptrdiff_t plane = 2 * job->pitch;
    vec_mask is_free = vec_mask_all();
    struct met met = {{vec_u16_set(0), vec_u16_set(0), vec_u16_set(0)}, vec_u16_set(0)};

    for (int t = 0; t < rays->tests[n]; t++) {
        const struct rf_limits l = rf_limits_of(rays, t, n);
        const ptrdiff_t q = p.at + 2 * (ptrdiff_t)rays->offset[t][n];
        const vec_u16 weight =
            load(job->weight, p.weight_at + 2 * (ptrdiff_t)rays->weight_offset[t][n]);
        const vec_mask hit = rf_in_limits(is_free, l, load(job->blur, q));

        is_free = vec_mask_without(is_free, hit);
        take(&met, load(job->blur, q + plane), load(job->blur, q + 2 * plane),
             load(job->blur, q + 3 * plane), weight, hit);
    }
    take(&met, load(rays->last[n], p.at), load(rays->last[n], p.at + plane),
         load(rays->last[n], p.at + 2 * plane),
         load(rays->last_weight[n], rays->last_behind[n] ? p.at : p.weight_at), is_free);
    return met;
}

static ALWAYS_INLINE void sweep_vector(uint64_t *const sum[4], int i,
                                       const struct rf_sweep_job *job)
{
    const struct place p = place_of(job, i);
    const vec_u16 one = vec_u16_set(1), zero = vec_u16_set(0);
    const int steps = steps_of[job->bright], rays = job->rays->rays;

    for (int n = 0; n < rays;) {
        const int end = n + steps < rays ? n + steps : rays;
        vec_u32 light[3] = {vec_u32_zero(), vec_u32_zero(), vec_u32_zero()};
        vec_u32 weight = vec_u32_zero();

        for (; n < end; n += 2) {
            const struct met a = follow(job, p, n);
            struct met b = {{zero, zero, zero}, zero};

            if (n + 1 < end)
                b = follow(job, p, n + 1);
            for (int c = 0; c < 3; c++)
                light[c] =
                    vec_u32_add_products(light[c], a.light[c], a.weight, b.light[c], b.weight);
            weight = vec_u32_add_products(weight, a.weight, one, b.weight, one);
        }
        n = end;
        for (int c = 0; c < 3; c++)
            vec_u32_add_to(sum[c] + i, light[c]);
        vec_u32_add_to(sum[3] + i, weight);
    }
}

static void RF_VEC(rf_sweep_weighted)(uint64_t *const sum[4], const struct rf_sweep_job *job)
{
    for (int i = 0; i < job->lanes; i += VEC_U16)
        sweep_vector(sum, i, job);
}

void RF_VEC(rf_sweep_weighted_use)(struct rf_kernels *kernels)
{
    kernels->sweep_weighted = RF_VEC(rf_sweep_weighted);
}
