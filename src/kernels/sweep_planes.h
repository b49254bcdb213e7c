/* sweep_planes.h: the template of the sweeps in plain C: what the ray of one pixel hits. */
#ifndef RF_KERNELS_SWEEP_PLANES_H
#define RF_KERNELS_SWEEP_PLANES_H

#include "kernels/sweep_view.h"

/* Where the light of the first plane lies that a ray hits, and its weight. */
struct rf_sweep_hit {
    const uint16_t *light, *weight;
};

/* Row y of a layout, elements from its first. */
static inline ptrdiff_t rf_row_of(const struct rf_row_layout *layout, int y, int rows)
{
    return y < rows / 2 ? y * layout->apart : layout->half + (y - rows / 2) * layout->apart;
}

/* Where in a row of weights that of element x lies. */
static inline int rf_weight_column(const struct rf_sweep_view *v, int x)
{
    return v->chroma ? x & ~1 : x;
}

/* Finds what ray n hits from the lane that lies p elements from the first of light, and w from
 * that of weights. */
static RF_ALWAYS_INLINE struct rf_sweep_hit rf_sweep_hit(const struct rf_sweep_view *v, int n,
                                                         ptrdiff_t p, ptrdiff_t w, const int planes,
                                                         const bool weighted)
{
    const bool as_light = planes > 1 && weighted && v->rays->last_is_background[n];

    for (int t = 0; t < v->rays->tests[n]; t++) {
        const ptrdiff_t q = p + v->offset[t][n];

        if (rf_in_range(v->rays->from[t][n], v->rays->to[t][n], (int16_t)v->blur[q]))
            return (struct rf_sweep_hit){v->light + q,
                                         weighted ? v->weight + w + v->weight_offset[t][n] : NULL};
    }
    return (struct rf_sweep_hit){v->last[n] + p,
                                 weighted ? v->last_weight[n] + (as_light ? p : w) : NULL};
}

static RF_ALWAYS_INLINE void rf_sweep_ray_plain(uint32_t *const *sum, const struct rf_sweep_view *v,
                                                int n, const int planes)
{
    for (int y = 0; y < v->rows; y++) {
        const ptrdiff_t p = rf_row_of(&v->layout, y, v->rows);

        for (int x = 0; x < RF_TILE; x++) {
            const struct rf_sweep_hit hit = rf_sweep_hit(v, n, p + x, 0, planes, false);

            for (int c = 0; c < planes; c++)
                sum[c][y * RF_TILE + x] += hit.light[c * v->pitch];
        }
    }
}

/* Sums of light. */
static RF_ALWAYS_INLINE void rf_sweep_planes(uint32_t *const *sum, const struct rf_sweep_view *v,
                                             const int planes)
{
    struct rf_ray_run run = {0, 0, -1};

    while (rf_next_run(&run, v, planes))
        for (int n = run.first; n < run.end; n++)
            rf_sweep_ray_plain(sum, v, n, planes);
}

static RF_ALWAYS_INLINE void rf_sweep_weighted_ray_plain(uint64_t *const *sum,
                                                         const struct rf_sweep_view *v, int n,
                                                         const int planes)
{
    for (int y = 0; y < v->rows; y++) {
        const ptrdiff_t p = rf_row_of(&v->layout, y, v->rows);
        const ptrdiff_t w = rf_row_of(&v->weight_layout, y, v->rows);

        for (int x = 0; x < RF_TILE; x++) {
            const struct rf_sweep_hit hit =
                rf_sweep_hit(v, n, p + x, w + rf_weight_column(v, x), planes, true);
            const int i = y * RF_TILE + x;
            const uint64_t weight = *hit.weight;

            for (int c = 0; c < planes; c++)
                sum[c][i] += weight * hit.light[c * v->pitch];
            sum[planes][i] += weight;
        }
    }
}

/* Sums of light times weight, and of weights. */
static RF_ALWAYS_INLINE void
rf_sweep_weighted_planes(uint64_t *const *sum, const struct rf_sweep_view *v, const int planes)
{
    struct rf_ray_run run = {0, 0, -1};

    while (rf_next_run(&run, v, planes))
        for (int n = run.first; n < run.end; n++)
            rf_sweep_weighted_ray_plain(sum, v, n, planes);
}

#endif
