/* sweep_vec.c: the sweep, a few vectors of pixels at a time, sums in registers over 16 rays. */
#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "simd/vec.h"

#include <string.h>

enum {
    MOST_VECS = 4,                      /* together: */
    ALONE_VECS = 4,                     /* of rays without tests, */
    TEST_VECS = 2,                      /* with them, or with weights */
    EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
};

#define ALWAYS_INLINE inline __attribute__((always_inline))

struct state {
    const struct rf_sweep_job *job;
    uint32_t *const *sum;
    uint16_t light[4][RF_STRIP_LANES]; /* sums of the last rays; [3]: of weights */
    int left;                          /* rays that they hold yet */
};

/* Where some vectors lie, in bytes of the planes of light, and of the weights. */
struct place {
    ptrdiff_t at, weight_at;
};

/* Vector j from `first` on; bytes. */
static ALWAYS_INLINE const char *vector_at(const char *first, ptrdiff_t stride, int j)
{
    return first + j / EACH * stride + j % EACH * (2 * VEC_U16);
}

/* Adds what lies at q where `mask` is set; NULL: everywhere. */
static ALWAYS_INLINE void add_plane(vec_u16 sum[MOST_VECS], const char *q, ptrdiff_t stride,
                                    const vec_mask *mask, const int vecs)
{
    for (int j = 0; j < vecs; j++) {
        const vec_u16 v = vec_u16_load(vector_at(q, stride, j));

        sum[j] = mask ? vec_u16_add_where(mask[j], sum[j], v) : vec_u16_add(sum[j], v);
    }
}

/* Test t of ray n. */
static ALWAYS_INLINE void test_ray(vec_u16 sum[4][MOST_VECS], vec_mask is_free[MOST_VECS],
                                   const struct rf_sweep_job *job, struct place p, int t, int n,
                                   const int vecs, const bool weighted)
{
    const struct rf_sorted_rays *rays = job->rays;
    const ptrdiff_t stride = 2 * job->stride, plane = 2 * job->pitch;
    const char *q = (const char *)job->blur + p.at + 2 * (ptrdiff_t)rays->offset[t][n];
    const struct rf_limits l = rf_limits_of(rays, t, n);
    vec_mask hit[MOST_VECS];

    for (int j = 0; j < vecs; j++) {
        const vec_u16 blur = vec_u16_load(vector_at(q, stride, j));

        if (t == 0)
            is_free[j] = vec_mask_all();
        hit[j] = rf_in_limits(is_free[j], l, blur);
        is_free[j] = vec_mask_without(is_free[j], hit[j]);
    }
    for (int c = 0; c < 3; c++)
        add_plane(sum[c], q + (c + 1) * plane, stride, hit, vecs);
    if (weighted)
        add_plane(sum[3],
                  (const char *)job->weight + p.weight_at +
                      2 * (ptrdiff_t)rays->weight_offset[t][n],
                  2 * job->weight_stride, hit, vecs);
}

/* Ray n. */
static ALWAYS_INLINE void sweep_ray(vec_u16 sum[4][MOST_VECS], const struct rf_sweep_job *job,
                                    struct place p, int n, const int vecs, const int tests,
                                    const bool weighted)
{
    const struct rf_sorted_rays *rays = job->rays;
    const ptrdiff_t stride = 2 * job->stride, plane = 2 * job->pitch;
    vec_mask is_free[MOST_VECS];
    const vec_mask *left = tests > 0 ? is_free : NULL;

    for (int t = 0; t < tests; t++)
        test_ray(sum, is_free, job, p, t, n, vecs, weighted);
    for (int c = 0; c < 3; c++)
        add_plane(sum[c], (const char *)rays->last[n] + p.at + c * plane, stride, left, vecs);
    if (weighted) {
        const bool behind = rays->last_behind[n];

        add_plane(sum[3], (const char *)rays->last_weight[n] + (behind ? p.at : p.weight_at),
                  behind ? stride : 2 * job->weight_stride, left, vecs);
    }
}

/* 16-bit sums of vectors from lane i on to where they have room; they are 0 then. */
static ALWAYS_INLINE void flush(uint32_t *const to[4], vec_u16 sum[4][MOST_VECS], int i,
                                const int vecs, const int planes)
{
    for (int c = 0; c < planes; c++)
        for (int j = 0; j < vecs; j++) {
            vec_u16_add_to(to[c] + i + j * VEC_U16, sum[c][j]);
            sum[c][j] = vec_u16_set(0);
        }
}

/* Rays first .. end - 1, all of `tests` tests. */
static ALWAYS_INLINE void sweep_rays(struct state *s, int first, int end, const int vecs,
                                     const int tests, const bool weighted)
{
    const struct rf_sweep_job *job = s->job;
    const int planes = weighted ? 4 : 3;
    int left = s->left;

    for (int i = 0; i < job->lanes; i += vecs * (int)VEC_U16) {
        const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;
        const struct place p = {2 * (y * job->stride + x), 2 * (y * job->weight_stride + x)};
        vec_u16 sum[4][MOST_VECS];

        left = s->left;
        for (int c = 0; c < planes; c++)
            for (int j = 0; j < vecs; j++)
                sum[c][j] = vec_u16_load(&s->light[c][i + j * VEC_U16]);
        for (int n = first; n < end;) {
            const int next = n + left < end ? n + left : end;

            left -= next - n;
            for (; n < next; n++)
                sweep_ray(sum, job, p, n, vecs, tests, weighted);
            if (left == 0) {
                flush(s->sum, sum, i, vecs, planes);
                left = job->steps;
            }
        }
        for (int c = 0; c < planes; c++)
            for (int j = 0; j < vecs; j++)
                vec_u16_store(&s->light[c][i + j * VEC_U16], sum[c][j]);
    }
    s->left = left;
}

static ALWAYS_INLINE void sweep_some(struct state *s, int first, int end, int tests,
                                     const bool weighted)
{
    switch (tests) {
    case 0:
        if (!weighted && s->job->lanes % (ALONE_VECS * (int)VEC_U16) == 0)
            sweep_rays(s, first, end, ALONE_VECS, 0, weighted);
        else
            sweep_rays(s, first, end, TEST_VECS, 0, weighted);
        break;
    case 1:
        sweep_rays(s, first, end, TEST_VECS, 1, weighted);
        break;
    case 2:
        sweep_rays(s, first, end, TEST_VECS, 2, weighted);
        break;
    case 3:
        sweep_rays(s, first, end, TEST_VECS, 3, weighted);
        break;
    default:
        sweep_rays(s, first, end, TEST_VECS, tests, weighted);
    }
}

static ALWAYS_INLINE void sweep_all(uint32_t *const sum[4], const struct rf_sweep_job *job,
                                    const bool weighted)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int planes = weighted ? 4 : 3;
    struct state s;

    s.job = job;
    s.sum = sum;
    s.left = job->steps;
    memset(s.light, 0, sizeof s.light[0] * (size_t)planes);
    for (int n = 0, end; n < rays->rays; n = end) {
        end = n + 1;
        while (end < rays->rays && rays->tests[end] == rays->tests[n])
            end++;
        sweep_some(&s, n, end, rays->tests[n], weighted);
    }
    for (int c = 0; c < planes; c++)
        for (int i = 0; i < job->lanes; i += (int)VEC_U16)
            vec_u16_add_to(sum[c] + i, vec_u16_load(&s.light[c][i]));
}

static void RF_VEC(rf_sweep)(uint32_t *const sum[4], const struct rf_sweep_job *job)
{
    if (sum[3])
        sweep_all(sum, job, true);
    else
        sweep_all(sum, job, false);
}

void RF_VEC(rf_kernels_use)(struct rf_kernels *kernels)
{
    kernels->sweep = RF_VEC(rf_sweep);
    RF_VEC(rf_aim_use)(kernels);
    RF_VEC(rf_windows_use)(kernels);
    RF_VEC(rf_smooth_use)(kernels);
    RF_VEC(rf_fill_use)(kernels);
    RF_VEC(rf_sweep_weighted_use)(kernels);
    RF_VEC(rf_weigh_use)(kernels);
    RF_VEC(rf_weigh1_use)(kernels);
    RF_VEC(rf_draw_disc_use)(kernels);
    RF_VEC(rf_hide_use)(kernels);
    RF_VEC(rf_discs_use)(kernels);
    RF_VEC(rf_light_use)(kernels);
    RF_VEC(rf_rows_use)(kernels);
    RF_VEC(rf_search_use)(kernels);
    RF_VEC(rf_dequantise_use)(kernels);
    RF_VEC(rf_series_use)(kernels);
    RF_VEC(rf_part_use)(kernels);
    RF_VEC(rf_surfaces_use)(kernels);
    RF_VEC(rf_thin_use)(kernels);
    RF_VEC(rf_sweep1_use)(kernels);
    RF_VEC(rf_sweep1_weighted_use)(kernels);
    RF_VEC(rf_upsample_use)(kernels);
    RF_VEC(rf_choose_use)(kernels);
    RF_VEC(rf_yuv_use)(kernels);
}
