#include "kernels/kernels.h"

#include <string.h>

/* Where pixel i of the strip lies in planes of a stride. */
static ptrdiff_t place(int i, ptrdiff_t stride)
{
    return i / RF_TILE * stride + i % RF_TILE;
}

static void add(uint32_t *const sum[4], int i, const uint16_t *light, ptrdiff_t pitch,
                const uint16_t *weight)
{
    for (int c = 0; c < 3; c++)
        sum[c][i] += light[c * pitch];
    if (sum[3])
        sum[3][i] += *weight;
}

/* Test t of ray n; pixels that hit are free no more. */
static void add_test(uint32_t *const sum[4], uint16_t *is_free, const struct rf_sweep_job *job,
                     int t, int n)
{
    const struct rf_sorted_rays *rays = job->rays;
    const uint16_t *weight = sum[3] ? job->weight + rays->weight_offset[t][n] : NULL;

    for (int i = 0; i < job->lanes; i++) {
        const int16_t *q = job->blur + place(i, job->stride) + rays->offset[t][n];

        if (!is_free[i] || !rf_in_range(rays->from[t][n], rays->to[t][n], *q))
            continue;
        is_free[i] = 0;
        add(sum, i, (const uint16_t *)q + job->pitch, job->pitch,
            weight ? weight + place(i, job->weight_stride) : NULL);
    }
}

void rf_sweep_c(uint32_t *const sum[4], const struct rf_sweep_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    uint16_t is_free[RF_STRIP_LANES];

    for (int n = 0; n < rays->rays; n++) {
        const uint16_t *weight = sum[3] ? rays->last_weight[n] : NULL;
        const ptrdiff_t stride = sum[3] && !rays->last_behind[n] ? job->weight_stride : job->stride;

        memset(is_free, 0xff, sizeof is_free);
        for (int t = 0; t < rays->tests[n]; t++)
            add_test(sum, is_free, job, t, n);
        for (int i = 0; i < job->lanes; i++)
            if (is_free[i])
                add(sum, i, rays->last[n] + place(i, job->stride), job->pitch,
                    weight ? weight + place(i, stride) : NULL);
    }
}
