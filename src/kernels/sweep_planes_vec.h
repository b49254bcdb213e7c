/* sweep_planes_vec.h: the template of the sweeps that sum plain light, some vectors of pixels at a
 * time.
 *
 * Rays with the same number of tests are summed together, so that the tests are unrolled. Sums have
 * 16 bits, and go to those of 32 bits after `steps` rays.
 *
 * A ray of three planes is followed from the front to the back: a mask tells which lanes are free
 * yet, which is one more operation a test. A ray of one plane is followed from the back to the
 * front: each slab that is hit overwrites the light of the ones it occludes, which needs no such
 * mask, but an operation more a plane.
 */
#ifndef RF_KERNELS_SWEEP_PLANES_VEC_H
#define RF_KERNELS_SWEEP_PLANES_VEC_H

#include "kernels/slab_vec.h"
#include "kernels/sweep_view.h"
#include "simd/vec.h"

enum {
    RF_EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
    RF_MOST_PLANES = 3,
    RF_MOST_VECS = 8, /* together, of a plane */
    RF_FEW_TESTS = 4, /* so many or more have no loop of their own */
};

/* Rows that are worked on together: `rows` of them from a row on, and as many of the other half,
 * where `halves` is 2. The first lies `at` elements from that of the view. */
struct rf_row_group {
    int row, rows, halves;
    ptrdiff_t at;
};

/* Vectors of a group. */
static RF_ALWAYS_INLINE int rf_vecs(const struct rf_row_group *g)
{
    return g->rows * g->halves * RF_EACH;
}

/* Where vector j of a group lies whose first one is at `first`. */
static RF_ALWAYS_INLINE const uint16_t *rf_vector_at(const uint16_t *first,
                                                     const struct rf_row_layout *layout, int j,
                                                     const struct rf_row_group *g)
{
    const uint16_t *const at = j < g->rows * RF_EACH ? first : first + layout->half;

    return at + j / RF_EACH % g->rows * layout->apart + j % RF_EACH * (int)VEC_U16;
}

static RF_ALWAYS_INLINE vec_u16 rf_load_at(const uint16_t *first,
                                           const struct rf_row_layout *layout, int j,
                                           const struct rf_row_group *g)
{
    return vec_u16_load(rf_vector_at(first, layout, j, g));
}

/* The lane that it begins with. */
static RF_ALWAYS_INLINE int rf_lane_at(const struct rf_sweep_view *v, int j,
                                       const struct rf_row_group *g)
{
    const int row = g->row + j / RF_EACH % g->rows + (j < g->rows * RF_EACH ? 0 : v->rows / 2);

    return row * RF_TILE + j % RF_EACH * (int)VEC_U16;
}

/* 16-bit sums of a group. */
typedef vec_u16 rf_sums[RF_MOST_PLANES][RF_MOST_VECS];

/* Adds what lies `at` elements from `from` on where `mask` is set; NULL: everywhere. */
static RF_ALWAYS_INLINE void rf_add_plane(vec_u16 sum[RF_MOST_VECS], const uint16_t *from,
                                          ptrdiff_t at, const struct rf_row_layout *layout,
                                          const vec_mask *mask, const struct rf_row_group *g)
{
    for (int j = 0; j < rf_vecs(g); j++) {
        const vec_u16 value = rf_load_at(from + at, layout, j, g);

        sum[j] = mask ? vec_u16_add_where(mask[j], sum[j], value) : vec_u16_add(sum[j], value);
    }
}

/* Adds what ray n of `tests` tests sees, from the front to the back. */
static RF_ALWAYS_INLINE void rf_sweep_forwards(rf_sums sum, const struct rf_sweep_view *v, int n,
                                               const int tests, const struct rf_row_group *g,
                                               const int planes)
{
    const struct rf_sorted_rays *rays = v->rays;
    vec_mask is_free[RF_MOST_VECS], hit[RF_MOST_VECS];
    const vec_mask *const left = tests > 0 ? is_free : NULL;

    for (int t = 0; t < tests; t++) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);
        const uint16_t *const q = v->blur + g->at + v->offset[t][n];

        for (int j = 0; j < rf_vecs(g); j++) {
            const vec_u16 blur = rf_load_at(q, &v->layout, j, g);

            if (t == 0)
                is_free[j] = vec_mask_all();
            hit[j] = rf_in_limits(is_free[j], limits, blur);
            is_free[j] = vec_mask_without(is_free[j], hit[j]);
        }
        for (int c = 0; c < planes; c++)
            rf_add_plane(sum[c], q, (c + 1) * v->pitch, &v->layout, hit, g);
    }
    for (int c = 0; c < planes; c++)
        rf_add_plane(sum[c], v->last[n], g->at + c * v->pitch, &v->layout, left, g);
}

/* Adds what ray n of one plane sees, from the back to the front. */
static RF_ALWAYS_INLINE void rf_sweep_backwards(rf_sums sum, const struct rf_sweep_view *v, int n,
                                                const int tests, const struct rf_row_group *g)
{
    const struct rf_row_layout *const l = &v->layout;
    vec_u16 light[RF_MOST_VECS];

    for (int j = 0; j < rf_vecs(g); j++)
        light[j] = rf_load_at(v->last[n] + g->at, l, j, g);
    for (int t = tests - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(v->rays, t, n);
        const ptrdiff_t q = g->at + v->offset[t][n];

        for (int j = 0; j < rf_vecs(g); j++) {
            const vec_mask hit =
                rf_in_limits(vec_mask_all(), limits, rf_load_at(v->blur + q, l, j, g));

            light[j] = vec_u16_load_where(hit, light[j], rf_vector_at(v->light + q, l, j, g));
        }
    }
    for (int j = 0; j < rf_vecs(g); j++)
        sum[0][j] = vec_u16_add(sum[0][j], light[j]);
}

/* The runs of rays of a view. */
struct rf_ray_runs {
    int count;
    struct rf_ray_run run[RF_RAY_CHUNK];
};

/* Adds 16-bit sums of a group to those of 32 bits, and clears them. */
static RF_ALWAYS_INLINE void rf_flush(uint32_t *const *to, rf_sums sum,
                                      const struct rf_sweep_view *v, const struct rf_row_group *g,
                                      const int planes)
{
    for (int c = 0; c < planes; c++)
        for (int j = 0; j < rf_vecs(g); j++) {
            vec_u16_add_to(to[c] + rf_lane_at(v, j, g), sum[c][j]);
            sum[c][j] = vec_u16_set(0);
        }
}

/* Adds what rays first to end - 1 see. */
static RF_ALWAYS_INLINE void rf_sweep_some(rf_sums sum, const struct rf_sweep_view *v, int first,
                                           int end, const int tests, const struct rf_row_group *g,
                                           const int planes)
{
    for (int n = first; n < end; n++) {
        const int own = tests < RF_FEW_TESTS ? tests : v->rays->tests[n];

        if (planes > 1)
            rf_sweep_forwards(sum, v, n, own, g, planes);
        else
            rf_sweep_backwards(sum, v, n, own, g);
    }
}

/* All rays at a group. */
static RF_ALWAYS_INLINE void rf_sweep_group(uint32_t *const *to, const struct rf_sweep_view *v,
                                            const struct rf_ray_runs *runs,
                                            const struct rf_row_group *g, const int planes)
{
    int left = v->steps; /* rays that the sums hold yet */
    rf_sums sum;

    for (int c = 0; c < planes; c++)
        for (int j = 0; j < rf_vecs(g); j++)
            sum[c][j] = vec_u16_set(0);
    for (const struct rf_ray_run *run = runs->run; run < runs->run + runs->count; run++) {
        for (int n = run->first, end; n < run->end; n = end) {
            end = run->end < n + left ? run->end : n + left;
            switch (run->tests) {
            case 0:
                rf_sweep_some(sum, v, n, end, 0, g, planes);
                break;
            case 1:
                rf_sweep_some(sum, v, n, end, 1, g, planes);
                break;
            case 2:
                rf_sweep_some(sum, v, n, end, 2, g, planes);
                break;
            case 3:
                rf_sweep_some(sum, v, n, end, 3, g, planes);
                break;
            default:
                rf_sweep_some(sum, v, n, end, RF_FEW_TESTS, g, planes);
            }
            left -= end - n;
            if (left == 0) {
                rf_flush(to, sum, v, g, planes);
                left = v->steps;
            }
        }
    }
    if (left < v->steps)
        rf_flush(to, sum, v, g, planes);
}

/* All rays at groups of `rows` rows, from row `row` on as far as they go. Returns the row after
 * them. One plane is worked on in rows of both halves. */
static RF_ALWAYS_INLINE int rf_sweep_rows(uint32_t *const *to, const struct rf_sweep_view *v,
                                          const struct rf_ray_runs *runs, int row, const int rows,
                                          const int planes)
{
    const int halves = planes > 1 ? 1 : 2, all = v->rows / halves;

    for (; row + rows <= all; row += rows) {
        const struct rf_row_group group = {row, rows, halves, row * v->layout.apart};

        rf_sweep_group(to, v, runs, &group, planes);
    }
    return row;
}

/* Sums of light. As many rows are worked on together as keep all in registers. */
static RF_ALWAYS_INLINE void rf_sweep_planes_vec(uint32_t *const *to, const struct rf_sweep_view *v,
                                                 const int planes)
{
    const int rows = (planes > 1 ? 2 : 4) / RF_EACH;
    struct rf_ray_run run = {0, 0, -1};
    struct rf_ray_runs runs;
    int row;

    runs.count = 0;
    while (rf_next_run(&run, v, planes))
        runs.run[runs.count++] = run;
    row = rf_sweep_rows(to, v, &runs, 0, rows, planes);
    if (rows > 3)
        row = rf_sweep_rows(to, v, &runs, row, 3, planes);
    if (rows > 2)
        row = rf_sweep_rows(to, v, &runs, row, 2, planes);
    if (rows > 1)
        rf_sweep_rows(to, v, &runs, row, 1, planes);
}

#endif
