/* sweep_planes_vec.h: the template of the sweeps without products, some vectors at a time.
 *
 * Rays of as many tests are taken together, so that the tests are unrolled. Sums have 16 bits, and
 * go to those of 32 bits after `steps` rays.
 *
 * A ray of three planes is followed from the front to the back: a mask tells which lanes are free
 * yet, which is one more operation a test. A ray of one plane is followed from the back to the
 * front: each slab overwrites what lies behind it where it is hit, which needs no such mask, but an
 * operation more a plane.
 */
#ifndef RF_KERNELS_SWEEP_PLANES_VEC_H
#define RF_KERNELS_SWEEP_PLANES_VEC_H

#include <string.h>

#include "kernels/slab_vec.h"
#include "kernels/sweep_view.h"
#include "simd/vec.h"

enum {
    RF_EACH = (int)RF_TILE / (int)VEC_U16, /* vectors of a row */
    RF_MOST_PLANES = 4,                    /* with that of weights */
    RF_MOST_VECS = 8,                      /* together, of a plane */
    RF_FEW_TESTS = 4,                      /* so many or more have no loop of their own */
};

/* Rows that are worked on together: `rows` of them from a row on, and as many of the other half,
 * where `halves` is 2. The first lies `at` elements from that of the view, and in its weights. */
struct rf_row_group {
    int row, rows, halves;
    ptrdiff_t at, weight_at;
};

/* Vectors of a group. */
static RF_ALWAYS_INLINE int rf_vecs(const struct rf_row_group *g)
{
    return g->rows * g->halves * RF_EACH;
}

/* Where the row of vector j of a group lies, elements from the group's first, and where in it. */
static RF_ALWAYS_INLINE ptrdiff_t rf_row_at(const struct rf_row_layout *layout, int j,
                                            const struct rf_row_group *g)
{
    const ptrdiff_t half = j < g->rows * RF_EACH ? 0 : layout->half;

    return half + j / RF_EACH % g->rows * layout->apart;
}

static RF_ALWAYS_INLINE int rf_column_at(int j)
{
    return j % RF_EACH * (int)VEC_U16;
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

/* Adds what lies `at` elements from `from` on where `mask` is set; NULL: everywhere. Places that
 * all rays have in common are added up before those of a ray are added, for the compiler. */
static RF_ALWAYS_INLINE void rf_add_plane(vec_u16 sum[RF_MOST_VECS], const uint16_t *from,
                                          ptrdiff_t at, const struct rf_row_layout *layout,
                                          const vec_mask *mask, const struct rf_row_group *g)
{
    for (int j = 0; j < rf_vecs(g); j++) {
        const vec_u16 value = vec_u16_load(from + (at + rf_row_at(layout, j, g)) + rf_column_at(j));

        sum[j] = mask ? vec_u16_add_where(mask[j], sum[j], value) : vec_u16_add(sum[j], value);
    }
}

/* Adds what ray n of `tests` tests sees, from the front to the back. */
static RF_ALWAYS_INLINE void rf_sweep_forwards(rf_sums sum, const struct rf_sweep_view *v, int n,
                                               const int tests, const struct rf_row_group *g,
                                               const int planes, const bool weighted)
{
    const struct rf_sorted_rays *rays = v->rays;
    vec_mask is_free[RF_MOST_VECS], hit[RF_MOST_VECS];
    const vec_mask *const left = tests > 0 ? is_free : NULL;

    for (int t = 0; t < tests; t++) {
        const struct rf_limits limits = rf_limits_of(rays, t, n);
        const uint16_t *const q = v->blur + g->at + v->offset[t][n];

        for (int j = 0; j < rf_vecs(g); j++) {
            const vec_u16 blur = vec_u16_load(q + rf_row_at(&v->layout, j, g) + rf_column_at(j));

            if (t == 0)
                is_free[j] = vec_mask_all();
            hit[j] = rf_in_limits(is_free[j], limits, blur);
            is_free[j] = vec_mask_without(is_free[j], hit[j]);
        }
        for (int c = 0; c < planes; c++)
            rf_add_plane(sum[c], q, (c + 1) * v->pitch, &v->layout, hit, g);
        if (weighted)
            rf_add_plane(sum[planes], v->weight + v->weight_offset[t][n], g->weight_at,
                         &v->weight_layout, hit, g);
    }
    for (int c = 0; c < planes; c++)
        rf_add_plane(sum[c], v->last[n], g->at + c * v->pitch, &v->layout, left, g);
    if (weighted && rays->last_behind[n])
        rf_add_plane(sum[planes], v->last_weight[n], g->at, &v->layout, left, g);
    else if (weighted)
        rf_add_plane(sum[planes], v->last_weight[n], g->weight_at, &v->weight_layout, left, g);
}

/* The same of one plane, from the back to the front. */
static RF_ALWAYS_INLINE void rf_sweep_backwards(rf_sums sum, const struct rf_sweep_view *v, int n,
                                                const int tests, const struct rf_row_group *g,
                                                const bool weighted)
{
    ptrdiff_t at[RF_MOST_VECS], weight_at[RF_MOST_VECS];
    vec_u16 light[RF_MOST_VECS], weight[RF_MOST_VECS];

    for (int j = 0; j < rf_vecs(g); j++) {
        at[j] = g->at + rf_row_at(&v->layout, j, g) + rf_column_at(j);
        weight_at[j] = g->weight_at + rf_row_at(&v->weight_layout, j, g) + rf_column_at(j);
    }
    for (int j = 0; j < rf_vecs(g); j++) {
        light[j] = vec_u16_load(v->last[n] + at[j]);
        if (weighted)
            weight[j] = vec_u16_load(v->last_weight[n] + weight_at[j]);
    }
    for (int t = tests - 1; t >= 0; t--) {
        const struct rf_limits limits = rf_limits_of(v->rays, t, n);
        const ptrdiff_t q = v->offset[t][n], p = weighted ? v->weight_offset[t][n] : 0;

        for (int j = 0; j < rf_vecs(g); j++) {
            const vec_mask hit =
                rf_in_limits(vec_mask_all(), limits, vec_u16_load(v->blur + q + at[j]));

            light[j] = vec_u16_load_where(hit, light[j], v->light + q + at[j]);
            if (weighted)
                weight[j] = vec_u16_load_where(hit, weight[j], v->weight + p + weight_at[j]);
        }
    }
    for (int j = 0; j < rf_vecs(g); j++) {
        sum[0][j] = vec_u16_add(sum[0][j], light[j]);
        if (weighted)
            sum[1][j] = vec_u16_add(sum[1][j], weight[j]);
    }
}

struct rf_sweep_state {
    uint32_t *const *to;
    int left; /* rays that the sums hold yet */
    uint16_t sum[RF_MOST_PLANES][RF_TILE * RF_TILE];
};

/* Adds 16-bit sums of a vector of a plane to those of 32 bits. */
static RF_ALWAYS_INLINE void rf_flush(const struct rf_sweep_state *s, const struct rf_sweep_view *v,
                                      int c, int lane, vec_u16 sum, const int planes)
{
    if (planes == 1 && c == planes && v->chroma)
        sum = vec_u16_twice(sum);
    vec_u16_add_to(s->to[c] + lane, sum);
}

/* A run of rays at a group. Returns how many rays the sums hold yet. */
static RF_ALWAYS_INLINE int rf_sweep_group(struct rf_sweep_state *s, const struct rf_sweep_view *v,
                                           struct rf_ray_run run, const int tests,
                                           const struct rf_row_group *g, const int planes,
                                           const bool weighted)
{
    int left = s->left;
    rf_sums sum;

    for (int c = 0; c < planes + weighted; c++)
        for (int j = 0; j < rf_vecs(g); j++)
            sum[c][j] = vec_u16_load(s->sum[c] + rf_lane_at(v, j, g));
    for (int n = run.first; n < run.end;) {
        const int next = n + left < run.end ? n + left : run.end;

        left -= next - n;
        for (; n < next; n++) {
            const int own = tests < RF_FEW_TESTS ? tests
                            : planes > 1         ? run.tests
                                                 : v->rays->tests[n];

            if (planes > 1)
                rf_sweep_forwards(sum, v, n, own, g, planes, weighted);
            else
                rf_sweep_backwards(sum, v, n, own, g, weighted);
        }
        if (left > 0)
            break;
        for (int c = 0; c < planes + weighted; c++)
            for (int j = 0; j < rf_vecs(g); j++) {
                rf_flush(s, v, c, rf_lane_at(v, j, g), sum[c][j], planes);
                sum[c][j] = vec_u16_set(0);
            }
        left = v->steps;
    }
    for (int c = 0; c < planes + weighted; c++)
        for (int j = 0; j < rf_vecs(g); j++)
            vec_u16_store(s->sum[c] + rf_lane_at(v, j, g), sum[c][j]);
    return left;
}

/* A run of rays at groups of `rows` rows, from row `row` on as far as they go. Returns the row
 * after them. */
static RF_ALWAYS_INLINE int rf_sweep_rows(struct rf_sweep_state *s, const struct rf_sweep_view *v,
                                          struct rf_ray_run run, const int tests, int row,
                                          const int rows, int *left, const int planes,
                                          const bool weighted)
{
    const int halves = planes > 1 ? 1 : 2, all = v->rows / halves;

    for (; row + rows <= all; row += rows) {
        const struct rf_row_group group = {row, rows, halves, row * v->layout.apart,
                                           row * v->weight_layout.apart};

        *left = rf_sweep_group(s, v, run, tests, &group, planes, weighted);
    }
    return row;
}

#if defined(__aarch64__)
enum { RF_ALONE_VECS = 4 }; /* of rays without tests: there are 32 registers */
#else
enum { RF_ALONE_VECS = 2 };
#endif

/* How many rows together keep all that is in work in registers. */
static RF_ALWAYS_INLINE int rf_rows_together(const int tests, const int planes, const bool weighted)
{
    if (planes > 1)
        return (tests == 0 && !weighted ? RF_ALONE_VECS : 2) / RF_EACH;
    return (weighted ? 2 : 4) / RF_EACH;
}

/* A run of rays at all rows. */
static RF_ALWAYS_INLINE void rf_sweep_run(struct rf_sweep_state *s, const struct rf_sweep_view *v,
                                          struct rf_ray_run run, const int tests, const int planes,
                                          const bool weighted)
{
    const int rows = rf_rows_together(tests, planes, weighted);
    int left = s->left, row = 0;

    row = rf_sweep_rows(s, v, run, tests, row, rows, &left, planes, weighted);
    if (rows > 3)
        row = rf_sweep_rows(s, v, run, tests, row, 3, &left, planes, weighted);
    if (rows > 2)
        row = rf_sweep_rows(s, v, run, tests, row, 2, &left, planes, weighted);
    if (rows > 1)
        rf_sweep_rows(s, v, run, tests, row, 1, &left, planes, weighted);
    s->left = left;
}

/* Sums of light, and, if weighted, in to[planes] of weights. */
static RF_ALWAYS_INLINE void rf_sweep_planes_vec(uint32_t *const *to, const struct rf_sweep_view *v,
                                                 const int planes, const bool weighted)
{
    struct rf_ray_run run = {0, 0, -1};
    struct rf_sweep_state s;

    s.to = to;
    s.left = v->steps;
    for (int c = 0; c < planes + weighted; c++)
        memset(s.sum[c], 0, (size_t)(v->rows * RF_TILE) * sizeof s.sum[c][0]);
    while (rf_next_run(&run, v, planes)) {
        switch (run.tests) {
        case 0:
            rf_sweep_run(&s, v, run, 0, planes, weighted);
            break;
        case 1:
            rf_sweep_run(&s, v, run, 1, planes, weighted);
            break;
        case 2:
            rf_sweep_run(&s, v, run, 2, planes, weighted);
            break;
        case 3:
            rf_sweep_run(&s, v, run, 3, planes, weighted);
            break;
        default:
            rf_sweep_run(&s, v, run, RF_FEW_TESTS, planes, weighted);
        }
    }
    for (int c = 0; c < planes + weighted; c++)
        for (int i = 0; i < v->rows * RF_TILE; i += (int)VEC_U16)
            rf_flush(&s, v, c, i, vec_u16_load(s.sum[c] + i), planes);
}

#endif
