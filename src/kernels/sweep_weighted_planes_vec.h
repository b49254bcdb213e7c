/* sweep_weighted_planes_vec.h: the template of the sweeps that sum light times weight, some vectors
 * of pixels at a time.
 *
 * Two rays are followed at once, as one instruction adds two products of light and weight, each
 * as in sweep_planes_vec.h: those of three planes to the back, those of one plane to the front.
 */
#ifndef RF_KERNELS_SWEEP_WEIGHTED_PLANES_VEC_H
#define RF_KERNELS_SWEEP_WEIGHTED_PLANES_VEC_H

#include "kernels/kernels.h"
#include "kernels/slab_vec.h"
#include "kernels/sweep_planes.h"
#include "simd/vec.h"

enum { RF_WEIGHTED_VECS = 2 }; /* at most, together */

/* Light and weight that one ray of each lane hits. */
struct rf_hits {
    vec_u16 light[3][RF_WEIGHTED_VECS], weight[RF_WEIGHTED_VECS];
};

/* Where vectors lie, elements from the first of light and of weights. */
struct rf_vec_place {
    ptrdiff_t at[RF_WEIGHTED_VECS], weight_at[RF_WEIGHTED_VECS];
};

static RF_ALWAYS_INLINE void rf_put_where(struct rf_hits *hits, int j, const uint16_t *light,
                                          ptrdiff_t at, ptrdiff_t pitch, const uint16_t *weight,
                                          vec_mask where, const int planes)
{
    for (int c = 0; c < planes; c++)
        hits->light[c][j] =
            vec_u16_put_where(where, hits->light[c][j], vec_u16_load(light + (at + c * pitch)));
    hits->weight[j] = vec_u16_put_where(where, hits->weight[j], vec_u16_load(weight));
}

/* Ray n of three planes, from the front to the back; all that is hit is 0 before. */
static RF_ALWAYS_INLINE void rf_follow_forwards(struct rf_hits *hits, const struct rf_sweep_view *v,
                                                const struct rf_vec_place *p, int n,
                                                const int planes, const int vecs)
{
    const struct rf_sorted_rays *rays = v->rays;
    const bool is_background = rays->last_is_background[n];
    vec_mask is_free[RF_WEIGHTED_VECS];

    for (int j = 0; j < vecs; j++)
        is_free[j] = vec_mask_all();
    for (int t = 0; t < rays->tests[n]; t++) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);

        for (int j = 0; j < vecs; j++) {
            const ptrdiff_t q = v->offset[t][n];
            const vec_mask hit =
                rf_in_limits(is_free[j], limits, vec_u16_load(v->blur + q + p->at[j]));

            is_free[j] = vec_mask_without(is_free[j], hit);
            rf_put_where(hits, j, v->light + q, p->at[j], v->pitch,
                         v->weight + v->weight_offset[t][n] + p->weight_at[j], hit, planes);
        }
    }
    for (int j = 0; j < vecs; j++)
        rf_put_where(hits, j, v->last[n], p->at[j], v->pitch,
                     v->last_weight[n] + (is_background ? p->at[j] : p->weight_at[j]), is_free[j],
                     planes);
}

/* Ray n of one plane, from the back to the front. */
static RF_ALWAYS_INLINE void rf_follow_backwards(struct rf_hits *hits,
                                                 const struct rf_sweep_view *v,
                                                 const struct rf_vec_place *p, int n,
                                                 const int vecs)
{
    const struct rf_sorted_rays *rays = v->rays;

    for (int j = 0; j < vecs; j++) {
        hits->light[0][j] = vec_u16_load(v->last[n] + p->at[j]);
        hits->weight[j] = vec_u16_load(v->last_weight[n] + p->weight_at[j]);
    }
    for (int t = rays->tests[n] - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);

        for (int j = 0; j < vecs; j++) {
            const ptrdiff_t q = p->at[j] + v->offset[t][n];
            const vec_mask hit = rf_in_limits(vec_mask_all(), limits, vec_u16_load(v->blur + q));

            hits->light[0][j] = vec_u16_load_where(hit, hits->light[0][j], v->light + q);
            hits->weight[j] = vec_u16_load_where(
                hit, hits->weight[j], v->weight + v->weight_offset[t][n] + p->weight_at[j]);
        }
    }
    for (int j = 0; v->chroma && j < vecs; j++)
        hits->weight[j] = vec_u16_twice(hits->weight[j]);
}

static RF_ALWAYS_INLINE void rf_follow(struct rf_hits *hits, const struct rf_sweep_view *v,
                                       const struct rf_vec_place *p, int n, const int planes,
                                       const int vecs)
{
    if (planes > 1)
        rf_follow_forwards(hits, v, p, n, planes, vecs);
    else
        rf_follow_backwards(hits, v, p, n, vecs);
}

static RF_ALWAYS_INLINE void rf_hit_nothing(struct rf_hits *hits, const int planes, const int vecs)
{
    for (int j = 0; j < vecs; j++) {
        for (int c = 0; c < planes; c++)
            hits->light[c][j] = vec_u16_set(0);
        hits->weight[j] = vec_u16_set(0);
    }
}

/* `count` rays, of one plane those in ray[], at some vectors, from `lane` on. */
static RF_ALWAYS_INLINE void rf_sweep_vectors(uint64_t *const *sum, int lane,
                                              const struct rf_sweep_view *v, const uint8_t *ray,
                                              int count, const struct rf_vec_place *p, int steps,
                                              const int planes, const int vecs)
{
    const vec_u16 one = vec_u16_set(1);

    for (int k = 0, end; k < count; k = end) {
        vec_u32 light[3][RF_WEIGHTED_VECS], weight[RF_WEIGHTED_VECS];

        for (int j = 0; j < vecs; j++) {
            for (int c = 0; c < planes; c++)
                light[c][j] = vec_u32_zero();
            weight[j] = vec_u32_zero();
        }
        end = count - k < steps ? count : k + steps;
        for (int i = k; i < end; i += 2) {
            struct rf_hits a, b;

            rf_hit_nothing(&a, planes, vecs);
            rf_follow(&a, v, p, planes > 1 ? i : ray[i], planes, vecs);
            rf_hit_nothing(&b, planes, vecs);
            if (i + 1 < end)
                rf_follow(&b, v, p, planes > 1 ? i + 1 : ray[i + 1], planes, vecs);
            for (int j = 0; j < vecs; j++) {
                for (int c = 0; c < planes; c++)
                    light[c][j] = vec_u32_add_products(light[c][j], a.light[c][j], a.weight[j],
                                                       b.light[c][j], b.weight[j]);
                weight[j] = vec_u32_add_products(weight[j], a.weight[j], one, b.weight[j], one);
            }
        }
        for (int j = 0; j < vecs; j++) {
            for (int c = 0; c < planes; c++)
                vec_u32_add_to(sum[c] + lane + j * (int)VEC_U16, light[c][j]);
            vec_u32_add_to(sum[planes] + lane + j * (int)VEC_U16, weight[j]);
        }
    }
}

/* Sums of light times weight, and of weights; 32 bits hold `steps` products. */
static RF_ALWAYS_INLINE void rf_sweep_weighted_planes_vec(uint64_t *const *sum,
                                                          const struct rf_sweep_view *v, int steps,
                                                          const int planes, const int vecs)
{
    struct rf_ray_run run = {0, 0, -1};
    uint8_t ray[RF_RAY_CHUNK];
    int count = planes > 1 ? v->rays->rays : 0;

    while (planes == 1 && rf_next_run(&run, v, planes))
        for (int n = run.first; n < run.end && count < RF_RAY_CHUNK; n++)
            ray[count++] = (uint8_t)n;
    for (int i = 0; i < v->rows * RF_TILE; i += vecs * (int)VEC_U16) {
        struct rf_vec_place p;

        for (int j = 0; j < vecs; j++) {
            const int lane = i + j * (int)VEC_U16, x = lane % RF_TILE, y = lane / RF_TILE;

            p.at[j] = rf_row_of(&v->layout, y, v->rows) + x;
            p.weight_at[j] = rf_row_of(&v->weight_layout, y, v->rows) + x;
        }
        rf_sweep_vectors(sum, i, v, ray, count, &p, steps, planes, vecs);
    }
}

#endif
