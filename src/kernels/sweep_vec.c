/* sweep_vec.c: the sweep, two vectors at a time, sums in registers over 16 rays. */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* Two vectors are a row of a tile at 128 bits, two rows at 256. */
enum {
    TWO_ROWS = (int)VEC_U16 == (int)RF_TILE,
    MANY = RF_BINS, /* slabs at the most */
    STEPS = 16, /* rays that a 16-bit sum of Q12 light holds: 16 * 4095 < 65536 */
    BRIGHT_STEPS = 4,
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct pair {
    vec_u16 a, b;
};

/* Bytes from the first vector of a pair to the second: half a tile's row, or a row. */
static ALWAYS_INLINE struct pair load(const char *at, ptrdiff_t second)
{
    return (struct pair){vec_u16_load(at), vec_u16_load(at + second)};
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

static ALWAYS_INLINE struct pair in_slab(struct pair blur, vec_u16 low, vec_u16 width)
{
    return (struct pair){vec_u16_at_most(vec_u16_sub(blur.a, low), width),
                         vec_u16_at_most(vec_u16_sub(blur.b, low), width)};
}

/* The rays of two vectors of pixels from `at` bytes on; `slabs` is a constant where it is
 * small. low and width hold each slab's in all lanes. */
static ALWAYS_INLINE void sweep_pair(uint32_t *sum[3], const struct rf_sweep_job *job,
                                     ptrdiff_t at, const vec_u16 *low, const vec_u16 *width,
                                     const int slabs, const bool uniform)
{
    const vec_u16 zero = vec_u16_set(0), ones = vec_u16_set(0xffff);
    const ptrdiff_t second = TWO_ROWS ? 2 * job->stride : 2 * VEC_U16;
    const ptrdiff_t plane = 2 * job->pitch;
    const char *const front = (const char *)job->blur + at;
    const char *const behind = (const char *)job->behind + at;
    const int rays = job->rays, steps = job->bright ? BRIGHT_STEPS : STEPS;

    for (int n = 0; n < rays;) {
        const int end = n + steps < rays ? n + steps : rays;
        struct pair r = {zero, zero}, g = r, b = r;

        for (; n < end; n++) {
            struct pair is_free = {ones, ones};
            const char *q;

            if (uniform) {
                q = front + 2 * (ptrdiff_t)job->offset[0][n];
                add(&r, load(q + plane, second));
                add(&g, load(q + 2 * plane, second));
                add(&b, load(q + 3 * plane, second));
                continue;
            }
            for (int k = 0; k < slabs; k++) {
                struct pair hit;

                q = front + 2 * (ptrdiff_t)job->offset[k][n];
                hit = in_slab(load(q, second), low[k], width[k]);
                if (k > 0)
                    hit = both(hit, is_free);
                is_free.a = vec_u16_without(is_free.a, hit.a);
                is_free.b = vec_u16_without(is_free.b, hit.b);
                add(&r, both(load(q + plane, second), hit));
                add(&g, both(load(q + 2 * plane, second), hit));
                add(&b, both(load(q + 3 * plane, second), hit));
            }
            q = behind + 2 * (ptrdiff_t)job->offset[slabs][n];
            add(&r, both(load(q, second), is_free));
            add(&g, both(load(q + plane, second), is_free));
            add(&b, both(load(q + 2 * plane, second), is_free));
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
    vec_u16 low[MANY], width[MANY];

    for (int k = 0; k < slabs; k++) {
        low[k] = vec_u16_set((uint16_t)job->slab[k].low);
        width[k] = vec_u16_set(job->slab[k].width);
    }
    for (int i = 0; i < RF_TILE * RF_TILE; i += 2 * VEC_U16) {
        const ptrdiff_t at = 2 * (i / RF_TILE * job->stride + i % RF_TILE);
        uint32_t *row[3] = {sum[0] + i, sum[1] + i, sum[2] + i};

        sweep_pair(row, job, at, low, width, slabs, uniform);
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
    RF_VEC(rf_sweep_weighted_use)(kernels);
    RF_VEC(rf_light_use)(kernels);
    RF_VEC(rf_rows_use)(kernels);
    RF_VEC(rf_search_use)(kernels);
}
