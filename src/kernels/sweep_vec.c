/* sweep_vec.c: the sweep, two vectors at a time, sums in registers over 16 rays. */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* Two vectors side by side make half a tile row's work on 128 bits, two rows on 256. */
enum {
    TWO_ROWS = (int)VEC_U16 == (int)RF_TILE,
    ROWS = TWO_ROWS ? 2 : 1,
    STEPS = 16, /* rays that a 16-bit sum of Q12 light holds: 16 * 4095 < 65536 */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct pair {
    vec_u16 a, b;
};

static ALWAYS_INLINE struct pair load(const void *row, ptrdiff_t second)
{
    return (struct pair){vec_u16_load(row), vec_u16_load((const uint16_t *)row + second)};
}

static ALWAYS_INLINE void add(struct pair *sum, struct pair v)
{
    sum->a = vec_u16_add(sum->a, v.a);
    sum->b = vec_u16_add(sum->b, v.b);
}

static ALWAYS_INLINE struct pair both(struct pair v, struct pair mask)
{
    return (struct pair){vec_u16_and(v.a, mask.a), vec_u16_and(v.b, mask.b)};
}

static ALWAYS_INLINE struct pair in_slab(struct pair blur, struct rf_slab slab)
{
    const vec_u16 low = vec_u16_set((uint16_t)slab.low), width = vec_u16_set(slab.width);

    return (struct pair){vec_u16_at_most(vec_u16_sub(blur.a, low), width),
                         vec_u16_at_most(vec_u16_sub(blur.b, low), width)};
}

/* The rays of two vectors of pixels; `slabs` is a constant where it is small. */
static ALWAYS_INLINE void sweep_pair(uint32_t *sum[3], const struct rf_sweep_job *job,
                                     ptrdiff_t at, const int slabs, const bool uniform)
{
    const vec_u16 zero = vec_u16_set(0), ones = vec_u16_set(0xffff);
    const ptrdiff_t second = TWO_ROWS ? job->stride : VEC_U16;
    const int16_t *const blur = job->blur + at;
    const uint16_t *const red = job->light[0] + at, *const green = job->light[1] + at,
                         *const blue = job->light[2] + at;
    const uint16_t *const behind0 = job->behind[0] + at, *const behind1 = job->behind[1] + at,
                         *const behind2 = job->behind[2] + at;
    const int rays = job->rays;

    for (int n = 0; n < rays;) {
        const int end = n + STEPS < rays ? n + STEPS : rays;
        struct pair r = {zero, zero}, g = r, b = r;

        for (; n < end; n++) {
            struct pair is_free = {ones, ones};
            ptrdiff_t q;

            if (uniform) {
                q = job->offset[0][n];
                add(&r, load(red + q, second));
                add(&g, load(green + q, second));
                add(&b, load(blue + q, second));
                continue;
            }
            for (int k = 0; k < slabs; k++) {
                struct pair hit;

                q = job->offset[k][n];
                hit = in_slab(load(blur + q, second), job->slab[k]);
                if (k > 0)
                    hit = both(hit, is_free);
                is_free.a = vec_u16_without(is_free.a, hit.a);
                is_free.b = vec_u16_without(is_free.b, hit.b);
                add(&r, both(load(red + q, second), hit));
                add(&g, both(load(green + q, second), hit));
                add(&b, both(load(blue + q, second), hit));
            }
            q = job->offset[slabs][n];
            add(&r, both(load(behind0 + q, second), is_free));
            add(&g, both(load(behind1 + q, second), is_free));
            add(&b, both(load(behind2 + q, second), is_free));
        }
        vec_u16_add_to(sum[0], r.a);
        vec_u16_add_to(sum[0] + VEC_U16, r.b);
        vec_u16_add_to(sum[1], g.a);
        vec_u16_add_to(sum[1] + VEC_U16, g.b);
        vec_u16_add_to(sum[2], b.a);
        vec_u16_add_to(sum[2] + VEC_U16, b.b);
    }
}

static ALWAYS_INLINE void sweep_rows(uint32_t sum[3][RF_TILE * RF_TILE],
                                     const struct rf_sweep_job *job, const int slabs,
                                     const bool uniform)
{
    for (int y = 0; y < RF_TILE; y += ROWS) {
        uint32_t *row[3] = {sum[0] + y * RF_TILE, sum[1] + y * RF_TILE,
                            sum[2] + y * RF_TILE};

        sweep_pair(row, job, y * job->stride, slabs, uniform);
    }
}

static void RF_VEC(rf_sweep)(uint32_t sum[3][RF_TILE * RF_TILE],
                             const struct rf_sweep_job *job)
{
    if (job->uniform) {
        sweep_rows(sum, job, 1, true);
        return;
    }
    switch (job->slabs) {
    case 1:
        sweep_rows(sum, job, 1, false);
        break;
    case 2:
        sweep_rows(sum, job, 2, false);
        break;
    case 3:
        sweep_rows(sum, job, 3, false);
        break;
    case 4:
        sweep_rows(sum, job, 4, false);
        break;
    default:
        sweep_rows(sum, job, job->slabs, false);
    }
}

void RF_VEC(rf_kernels_use)(struct rf_kernels *kernels)
{
    kernels->sweep = RF_VEC(rf_sweep);
    RF_VEC(rf_rows_use)(kernels);
}
