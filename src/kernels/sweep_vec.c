/* sweep_vec.c: the sweep, a few vectors of pixels at a time, sums in registers over 16 rays. */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

#include <string.h>

enum {
    STEPS = 16, /* rays that a 16-bit sum of Q12 light holds: 16 * 4095 < 65536 */
    MOST_VECS = 4,  /* together: */
    ALONE_VECS = 4, /* of rays without tests, */
    TEST_VECS = 2,  /* and with them */
    EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
};

/* Rays that it holds of light 4, 8 and 16 times as bright. */
static const uint8_t steps_of[] = {
    [RF_WHITE] = STEPS, [RF_BRIGHT] = 4, [RF_BRIGHTER] = 2, [RF_BRIGHTEST] = 1};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct state {
    const struct rf_sweep_job *job;
    uint16_t light[3][RF_STRIP_LANES]; /* sums of the last rays */
};

/* Vector j from `first` on; bytes. */
static ALWAYS_INLINE const char *vector_at(const char *first, ptrdiff_t stride, int j)
{
    return first + j / EACH * stride + j % EACH * (2 * VEC_U16);
}

/* Adds a ray's light where `mask` is set; NULL: everywhere. */
static ALWAYS_INLINE void add_light(vec_u16 sum[3][MOST_VECS], const char *q, ptrdiff_t stride,
                                    ptrdiff_t plane, const vec_mask *mask, const int vecs)
{
    for (int c = 0; c < 3; c++, q += plane) {
        for (int j = 0; j < vecs; j++) {
            const vec_u16 light = vec_u16_load(vector_at(q, stride, j));

            sum[c][j] = mask ? vec_u16_add_where(mask[j], sum[c][j], light)
                             : vec_u16_add(sum[c][j], light);
        }
    }
}

/* Ray n at the vectors that begin `at` bytes from the strip's first pixel. */
static ALWAYS_INLINE void sweep_ray(vec_u16 sum[3][MOST_VECS], const struct state *s,
                                    ptrdiff_t at, int n, const int vecs, const int tests)
{
    const ptrdiff_t stride = 2 * s->job->stride, plane = 2 * s->job->pitch;
    const struct rf_sorted_rays *rays = s->job->rays;
    vec_mask is_free[MOST_VECS];

    for (int t = 0; t < tests; t++) {
        const char *q = (const char *)s->job->blur + at + 2 * (ptrdiff_t)rays->offset[t][n];
        const struct rf_limits l = rf_limits_of(rays, t, n);
        vec_mask hit[MOST_VECS];

        for (int j = 0; j < vecs; j++) {
            const vec_u16 blur = vec_u16_load(vector_at(q, stride, j));

            if (t == 0)
                is_free[j] = vec_mask_all();
            hit[j] = rf_in_limits(is_free[j], l, blur);
            is_free[j] = vec_mask_without(is_free[j], hit[j]);
        }
        add_light(sum, q + plane, stride, plane, hit, vecs);
    }
    add_light(sum, (const char *)rays->last[n] + at, stride, plane, tests > 0 ? is_free : NULL,
              vecs);
}

/* Rays first .. end - 1, at most as many as 16-bit sums hold, all of `tests` tests. */
static ALWAYS_INLINE void sweep_rays(struct state *s, int first, int end, const int vecs,
                                     const int tests)
{
    for (int i = 0; i < s->job->lanes; i += vecs * (int)VEC_U16) {
        const ptrdiff_t at = 2 * (i / RF_TILE * s->job->stride + i % RF_TILE);
        vec_u16 sum[3][MOST_VECS];

        for (int c = 0; c < 3; c++)
            for (int j = 0; j < vecs; j++)
                sum[c][j] = vec_u16_load(&s->light[c][i + j * VEC_U16]);
        for (int n = first; n < end; n++)
            sweep_ray(sum, s, at, n, vecs, tests);
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < vecs; j++)
                vec_u16_store(&s->light[c][i + j * VEC_U16], sum[c][j]);
    }
}

static void sweep_some(struct state *s, int first, int end, int tests)
{
    switch (tests) {
    case 0:
        if (s->job->lanes % (ALONE_VECS * (int)VEC_U16) == 0)
            sweep_rays(s, first, end, ALONE_VECS, 0);
        else
            sweep_rays(s, first, end, TEST_VECS, 0);
        break;
    case 1:
        sweep_rays(s, first, end, TEST_VECS, 1);
        break;
    case 2:
        sweep_rays(s, first, end, TEST_VECS, 2);
        break;
    case 3:
        sweep_rays(s, first, end, TEST_VECS, 3);
        break;
    default:
        sweep_rays(s, first, end, TEST_VECS, tests);
    }
}

static void flush(uint32_t *const sum[3], struct state *s)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < s->job->lanes; i += VEC_U16)
            vec_u16_add_to(sum[c] + i, vec_u16_load(&s->light[c][i]));
    memset(s->light, 0, sizeof s->light);
}

static void RF_VEC(rf_sweep)(uint32_t *const sum[3], const struct rf_sweep_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int steps = steps_of[job->bright];
    int left = steps;
    struct state s;

    s.job = job;
    memset(s.light, 0, sizeof s.light);
    for (int n = 0, end; n < rays->rays; n = end) {
        end = n + 1;
        while (end < rays->rays && rays->tests[end] == rays->tests[n] && end < n + left)
            end++;
        sweep_some(&s, n, end, rays->tests[n]);
        left -= end - n;
        if (left == 0) {
            flush(sum, &s);
            left = steps;
        }
    }
    if (left < steps)
        flush(sum, &s);
}

void RF_VEC(rf_kernels_use)(struct rf_kernels *kernels)
{
    kernels->sweep = RF_VEC(rf_sweep);
    RF_VEC(rf_aim_use)(kernels);
    RF_VEC(rf_smooth_use)(kernels);
    RF_VEC(rf_fill_use)(kernels);
    RF_VEC(rf_sweep_weighted_use)(kernels);
    RF_VEC(rf_light_use)(kernels);
    RF_VEC(rf_rows_use)(kernels);
    RF_VEC(rf_search_use)(kernels);
    RF_VEC(rf_series_use)(kernels);
    RF_VEC(rf_surfaces_use)(kernels);
    RF_VEC(rf_sweep1_use)(kernels);
    RF_VEC(rf_upsample_use)(kernels);
    RF_VEC(rf_choose_use)(kernels);
    RF_VEC(rf_yuv_use)(kernels);
}
