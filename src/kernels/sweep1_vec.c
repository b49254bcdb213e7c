/* sweep1_vec.c: the sweep of one plane, four vectors at a time.
 *
 * A ray is followed from behind to the front: each slab overwrites what lies behind it where
 * it is hit, so that one addition a ray is left.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum {
    VECS = 4,
    PER_ROW = RF_TILE / VEC_U16,
    MANY = RF_BINS, /* slabs at the most */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

/* 0 <= s - low <= width as one signed comparison: s - from < to. */
struct bounds {
    vec_u16 from, to;
};

static ALWAYS_INLINE void load(vec_u16 v[VECS], const uint16_t *at, ptrdiff_t stride)
{
    for (int i = 0; i < VECS; i++)
        v[i] = vec_u16_load(at + i / PER_ROW * stride + i % PER_ROW * VEC_U16);
}

/* The rays of VECS vectors of elements from p on; `slabs` is a constant where it is small. */
static ALWAYS_INLINE void sweep_vectors(uint32_t *sum, const struct rf_sweep1_job *job,
                                        ptrdiff_t p, const struct bounds *bounds,
                                        const int slabs, const bool uniform)
{
    const ptrdiff_t stride = job->stride;
    const uint16_t *const blur = (const uint16_t *)job->blur + p;
    const uint16_t *const light = job->light + p, *const behind = job->behind + p;
    const int rays = job->rays, steps = job->steps;

    for (int n = 0; n < rays;) {
        const int end = n + steps < rays ? n + steps : rays;
        vec_u16 part[VECS];

        for (int i = 0; i < VECS; i++)
            part[i] = vec_u16_set(0);
        for (; n < end; n++) {
            vec_u16 value[VECS], s[VECS], front[VECS];

            if (uniform) {
                load(value, light + job->offset[0][n], stride);
            } else {
                load(value, behind + job->offset[slabs][n], stride);
                for (int k = slabs - 1; k >= 0; k--) {
                    load(s, blur + job->offset[k][n], stride);
                    load(front, light + job->offset[k][n], stride);
                    for (int i = 0; i < VECS; i++)
                        value[i] = vec_u16_select(
                            vec_s16_less(vec_u16_sub(s[i], bounds[k].from), bounds[k].to),
                            front[i], value[i]);
                }
            }
            for (int i = 0; i < VECS; i++)
                part[i] = vec_u16_add(part[i], value[i]);
        }
        for (int i = 0; i < VECS; i++)
            vec_u16_add_to(sum + i * VEC_U16, part[i]);
    }
}

static ALWAYS_INLINE void sweep_rows(uint32_t *sum, const struct rf_sweep1_job *job,
                                     const int slabs, const bool uniform)
{
    struct bounds bounds[MANY];

    for (int k = 0; k < slabs; k++) {
        /* adding 2^15 makes an unsigned comparison of a signed one */
        bounds[k].from = vec_u16_set((uint16_t)(job->slab[k].low ^ 0x8000));
        bounds[k].to = vec_u16_set((uint16_t)((job->slab[k].width + 1) ^ 0x8000));
    }
    for (int i = 0; i < job->rows * RF_TILE; i += VECS * VEC_U16)
        sweep_vectors(sum + i, job, i / RF_TILE * job->stride, bounds, slabs, uniform);
}

static void RF_VEC(rf_sweep1)(uint32_t sum[RF_TILE * RF_TILE], const struct rf_sweep1_job *job)
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

void RF_VEC(rf_sweep1_use)(struct rf_kernels *kernels)
{
    kernels->sweep1 = RF_VEC(rf_sweep1);
}
