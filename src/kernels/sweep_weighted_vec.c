/* sweep_weighted_vec.c: the sweep with weights, one vector at a time, two rays at once. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum {
    MANY = RF_BINS,
    STEPS = 16, /* rays that a 32-bit sum holds: 16 * 4095 * 32767 < 2^31 */
    BRIGHT_STEPS = 4,
};

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
                               vec_u16 weight, vec_u16 where)
{
    met->light[0] = vec_u16_or(met->light[0], vec_u16_and(red, where));
    met->light[1] = vec_u16_or(met->light[1], vec_u16_and(green, where));
    met->light[2] = vec_u16_or(met->light[2], vec_u16_and(blue, where));
    met->weight = vec_u16_or(met->weight, vec_u16_and(weight, where));
}

/* Ray n of the vector `at` bytes into the tile, `weight_at` in the plane of weights. */
static ALWAYS_INLINE struct met follow(const struct rf_sweep_job *job, ptrdiff_t at,
                                       ptrdiff_t weight_at, int n, const vec_u16 *low,
                                       const vec_u16 *width, const int slabs,
                                       const bool uniform)
{
    const ptrdiff_t plane = 2 * job->pitch;
    vec_u16 is_free = vec_u16_set(0xffff);
    struct met met = {{vec_u16_set(0), vec_u16_set(0), vec_u16_set(0)}, vec_u16_set(0)};
    ptrdiff_t q;

    for (int k = 0; k < slabs; k++) {
        const vec_u16 weight = load(job->weight, weight_at + 2 * job->weight_offset[k][n]);
        vec_u16 hit = is_free;

        q = at + 2 * (ptrdiff_t)job->offset[k][n];
        if (!uniform) {
            hit = vec_u16_at_most(vec_u16_sub(load(job->blur, q), low[k]), width[k]);
            hit = k > 0 ? vec_u16_and(hit, is_free) : hit;
            is_free = vec_u16_without(is_free, hit);
        }
        take(&met, load(job->blur, q + plane), load(job->blur, q + 2 * plane),
             load(job->blur, q + 3 * plane), weight, hit);
    }
    if (uniform)
        return met;
    q = at + 2 * (ptrdiff_t)job->offset[slabs][n];
    take(&met, load(job->behind, q), load(job->behind, q + plane),
         load(job->behind, q + 2 * plane), load(job->behind_weight, q), is_free);
    return met;
}

static ALWAYS_INLINE void sweep_vector(uint64_t *sum[4], const struct rf_sweep_job *job,
                                       ptrdiff_t at, ptrdiff_t weight_at, const vec_u16 *low,
                                       const vec_u16 *width, const int slabs,
                                       const bool uniform)
{
    const vec_u16 one = vec_u16_set(1), zero = vec_u16_set(0);
    const int steps = job->bright ? BRIGHT_STEPS : STEPS;

    for (int n = 0; n < job->rays;) {
        const int end = n + steps < job->rays ? n + steps : job->rays;
        vec_u32 light[3] = {vec_u32_zero(), vec_u32_zero(), vec_u32_zero()};
        vec_u32 weight = vec_u32_zero();

        for (; n < end; n += 2) {
            const struct met a = follow(job, at, weight_at, n, low, width, slabs, uniform);
            struct met b = {{zero, zero, zero}, zero};

            if (n + 1 < end)
                b = follow(job, at, weight_at, n + 1, low, width, slabs, uniform);
            for (int c = 0; c < 3; c++)
                light[c] = vec_u32_add_products(light[c], a.light[c], a.weight, b.light[c],
                                                b.weight);
            weight = vec_u32_add_products(weight, a.weight, one, b.weight, one);
        }
        n = end;
        for (int c = 0; c < 3; c++)
            vec_u32_add_to(sum[c], light[c]);
        vec_u32_add_to(sum[3], weight);
    }
}

static ALWAYS_INLINE void sweep_tile(uint64_t sum[4][RF_TILE * RF_TILE],
                                     const struct rf_sweep_job *job, const int slabs,
                                     const bool uniform)
{
    vec_u16 low[MANY], width[MANY];

    for (int k = 0; k < slabs; k++) {
        low[k] = vec_u16_set((uint16_t)job->slab[k].low);
        width[k] = vec_u16_set(job->slab[k].width);
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i += VEC_U16) {
        const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;
        uint64_t *to[4] = {sum[0] + i, sum[1] + i, sum[2] + i, sum[3] + i};

        sweep_vector(to, job, 2 * (y * job->stride + x), 2 * (y * job->weight_stride + x), low,
                     width, slabs, uniform);
    }
}

static void RF_VEC(rf_sweep_weighted)(uint64_t sum[4][RF_TILE * RF_TILE],
                                      const struct rf_sweep_job *job)
{
    if (job->uniform)
        sweep_tile(sum, job, 1, true);
    else if (job->slabs == 1)
        sweep_tile(sum, job, 1, false);
    else if (job->slabs == 2)
        sweep_tile(sum, job, 2, false);
    else if (job->slabs == 3)
        sweep_tile(sum, job, 3, false);
    else if (job->slabs == 4)
        sweep_tile(sum, job, 4, false);
    else
        sweep_tile(sum, job, job->slabs, false);
}

void RF_VEC(rf_sweep_weighted_use)(struct rf_kernels *kernels)
{
    kernels->sweep_weighted = RF_VEC(rf_sweep_weighted);
}
