#include "kernels/kernels.h"

#include <string.h>

static void add(uint32_t *const sum[3], const uint16_t *light, ptrdiff_t pitch, int i)
{
    for (int c = 0; c < 3; c++)
        sum[c][i] += light[c * pitch];
}

/* Test t of ray n; pixels that hit are free no more. */
static void add_test(uint32_t *const sum[3], uint16_t *is_free, const struct rf_sweep_job *job,
                     int t, int n)
{
    const struct rf_sorted_rays *rays = job->rays;

    for (int i = 0; i < job->lanes; i++) {
        const int16_t *q = job->blur + i / RF_TILE * job->stride + i % RF_TILE +
                           rays->offset[t][n];

        if (!is_free[i] || !rf_in_range(rays->from[t][n], rays->to[t][n], *q))
            continue;
        is_free[i] = 0;
        add(sum, (const uint16_t *)q + job->pitch, job->pitch, i);
    }
}

void rf_sweep_c(uint32_t *const sum[3], const struct rf_sweep_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    uint16_t is_free[RF_STRIP_LANES];

    for (int n = 0; n < rays->rays; n++) {
        memset(is_free, 0xff, sizeof is_free);
        for (int t = 0; t < rays->tests[n]; t++)
            add_test(sum, is_free, job, t, n);
        for (int i = 0; i < job->lanes; i++)
            if (is_free[i])
                add(sum, rays->last[n] + i / RF_TILE * job->stride + i % RF_TILE, job->pitch,
                    i);
    }
}
