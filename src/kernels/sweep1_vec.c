/* sweep1_vec.c: the sweep of one plane, four vectors at a time.
 *
 * A ray is followed from behind to the front: each slab overwrites what lies behind it where
 * it is hit, so that one addition a ray is left.
 */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

#include <string.h>

enum {
    VECS = 4,
    EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct state {
    const struct rf_sweep1_job *job;
    uint16_t light[RF_TILE * RF_TILE]; /* sums of the last rays */
};

static ALWAYS_INLINE void load(vec_u16 v[VECS], const uint16_t *at,
                               const ptrdiff_t place[VECS], const int vecs)
{
    for (int j = 0; j < vecs; j++)
        v[j] = vec_u16_load(at + place[j]);
}

/* Rays first .. end - 1, at most as many as 16-bit sums hold, all of `tests` tests, which is a
 * constant where it is small, at `vecs` vectors from vector i on. */
static ALWAYS_INLINE void sweep_vectors(struct state *s, int first, int end, const int tests,
                                        int i, const int vecs)
{
    const struct rf_sorted_rays *rays = s->job->rays;
    const uint16_t *const blur = (const uint16_t *)s->job->blur, *const light = s->job->light;
    uint16_t *const to = &s->light[i * (int)VEC_U16];
    ptrdiff_t place[VECS];
    vec_u16 sum[VECS];

    for (int j = 0; j < vecs; j++) {
        place[j] = s->job->row[(i + j) / EACH] + (i + j) % EACH * (int)VEC_U16;
        sum[j] = vec_u16_load(to + j * (int)VEC_U16);
    }
    for (int n = first; n < end; n++) {
        vec_u16 value[VECS];

        load(value, rays->last[n], place, vecs);
        for (int t = tests - 1; t >= 0; t--) {
            const struct rf_limits l = rf_limits_of(rays, t, n);
            const ptrdiff_t q = rays->offset[t][n];
            vec_u16 seen[VECS], front[VECS];

            load(seen, blur + q, place, vecs);
            load(front, light + q, place, vecs);
            for (int j = 0; j < vecs; j++)
                value[j] = vec_u16_choose(rf_in_limits(vec_mask_all(), l, seen[j]),
                                          front[j], value[j]);
        }
        for (int j = 0; j < vecs; j++)
            sum[j] = vec_u16_add(sum[j], value[j]);
    }
    for (int j = 0; j < vecs; j++)
        vec_u16_store(to + j * (int)VEC_U16, sum[j]);
}

static ALWAYS_INLINE void sweep_rays(struct state *s, int first, int end, const int tests)
{
    const int vectors = s->job->rows * EACH;
    int i = 0;

    for (; i + VECS <= vectors; i += VECS)
        sweep_vectors(s, first, end, tests, i, VECS);
    if (i < vectors)
        sweep_vectors(s, first, end, tests, i, VECS / 2);
}

static void sweep_some(struct state *s, int first, int end, int tests)
{
    switch (tests) {
    case 0:
        sweep_rays(s, first, end, 0);
        break;
    case 1:
        sweep_rays(s, first, end, 1);
        break;
    case 2:
        sweep_rays(s, first, end, 2);
        break;
    case 3:
        sweep_rays(s, first, end, 3);
        break;
    default:
        sweep_rays(s, first, end, tests);
    }
}

static void flush(uint32_t *sum, struct state *s)
{
    const int lanes = s->job->rows * RF_TILE;

    for (int i = 0; i < lanes; i += (int)VEC_U16)
        vec_u16_add_to(sum + i, vec_u16_load(&s->light[i]));
    memset(s->light, 0, (size_t)lanes * sizeof s->light[0]);
}

static void RF_VEC(rf_sweep1)(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    int left = job->steps;
    struct state s;

    s.job = job;
    memset(s.light, 0, (size_t)job->rows * RF_TILE * sizeof s.light[0]);
    for (int n = 0, end; n < rays->rays; n = end) {
        end = n + 1;
        while (end < rays->rays && rays->tests[end] == rays->tests[n] && end < n + left)
            end++;
        sweep_some(&s, n, end, rays->tests[n]);
        left -= end - n;
        if (left == 0) {
            flush(sum, &s);
            left = job->steps;
        }
    }
    if (left < job->steps)
        flush(sum, &s);
}

void RF_VEC(rf_sweep1_use)(struct rf_kernels *kernels)
{
    kernels->sweep1 = RF_VEC(rf_sweep1);
}
