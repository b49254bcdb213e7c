#include "kernels/kernels.h"

/* Where lane i is, elements from the first. */
static ptrdiff_t at(const struct rf_sweep1_job *job, int i)
{
    const int y = i / RF_TILE, half = job->rows / 2;

    return (y < half ? y * job->apart : job->half + (y - half) * job->apart) + i % RF_TILE;
}

void rf_sweep1_c(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int32_t(*const offset)[RF_RAY_CHUNK] =
        job->chroma ? (const int32_t(*)[RF_RAY_CHUNK])rays->chroma_offset
                    : (const int32_t(*)[RF_RAY_CHUNK])rays->offset;
    const int lanes = job->rows * RF_TILE;
    int class = 0; /* of tests */

    for (int n = 0; n < rays->rays; n++) {
        uint16_t value[RF_TILE * RF_TILE];

        while (n == rays->begin[class + 1])
            class++;
        if (job->chroma && n - rays->begin[class] >= rays->shared[class])
            continue;
        /* from the last to the nearest, which overwrites what lies behind it */
        for (int i = 0; i < lanes; i++)
            value[i] = (job->chroma ? rays->chroma_last : rays->last)[n][at(job, i)];
        for (int t = rays->tests[n] - 1; t >= 0; t--) {
            for (int i = 0; i < lanes; i++) {
                const ptrdiff_t q = at(job, i) + offset[t][n];

                if (rf_in_range(rays->from[t][n], rays->to[t][n], job->blur[q]))
                    value[i] = job->light[q];
            }
        }
        for (int i = 0; i < lanes; i++)
            sum[i] += value[i];
    }
}
