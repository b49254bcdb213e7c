#include "kernels/kernels.h"

static void add(uint64_t *const sum[4], int i, const uint16_t *light, ptrdiff_t pitch,
                uint64_t weight)
{
    for (int c = 0; c < 3; c++)
        sum[c][i] += weight * light[c * pitch];
    sum[3][i] += weight;
}

/* Whether test t of ray n hits for pixel i; then it is added. */
static bool hits(uint64_t *const sum[4], const struct rf_sweep_job *job, int i, int t, int n)
{
    const struct rf_sorted_rays *rays = job->rays;
    const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;
    const int16_t *const q = job->blur + y * job->stride + x + rays->offset[t][n];

    if (!rf_in_range(rays->from[t][n], rays->to[t][n], *q))
        return false;
    add(sum, i, (const uint16_t *)q + job->pitch, job->pitch,
        job->weight[y * job->weight_stride + x + rays->weight_offset[t][n]]);
    return true;
}

void rf_sweep_weighted_c(uint64_t *const sum[4], const struct rf_sweep_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;

    for (int n = 0; n < rays->rays; n++) {
        const ptrdiff_t stride = rays->last_behind[n] ? job->stride : job->weight_stride;

        for (int i = 0; i < job->lanes; i++) {
            const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;
            int t = 0;

            while (t < rays->tests[n] && !hits(sum, job, i, t, n))
                t++;
            if (t == rays->tests[n])
                add(sum, i, rays->last[n] + y * job->stride + x, job->pitch,
                    rays->last_weight[n][y * stride + x]);
        }
    }
}
