#include "kernels/kernels.h"

void rf_sweep1_c(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int lanes = job->rows * RF_TILE;

    for (int n = 0; n < rays->rays; n++) {
        uint16_t value[RF_TILE * RF_TILE];

        /* from the last to the nearest, which overwrites what lies behind it */
        for (int i = 0; i < lanes; i++)
            value[i] = rays->last[n][job->row[i / RF_TILE] + i % RF_TILE];
        for (int t = rays->tests[n] - 1; t >= 0; t--) {
            for (int i = 0; i < lanes; i++) {
                const ptrdiff_t q =
                    job->row[i / RF_TILE] + i % RF_TILE + rays->offset[t][n];

                if (rf_in_range(rays->from[t][n], rays->to[t][n], job->blur[q]))
                    value[i] = job->light[q];
            }
        }
        for (int i = 0; i < lanes; i++)
            sum[i] += value[i];
    }
}
