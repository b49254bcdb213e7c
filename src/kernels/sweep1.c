#include "kernels/kernels.h"

void rf_sweep1_c(uint32_t sum[RF_TILE * RF_TILE], const struct rf_sweep1_job *job)
{
    const int lanes = job->rows * RF_TILE;

    for (int n = 0; n < job->rays; n++) {
        uint16_t value[RF_TILE * RF_TILE];

        /* from behind, so that the nearest slab is the last to be written */
        for (int i = 0; i < lanes; i++)
            value[i] = job->behind[i / RF_TILE * job->stride + i % RF_TILE +
                                   job->offset[job->slabs][n]];
        for (int k = job->slabs - 1; k >= 0; k--) {
            const int16_t low = job->slab[k].low;
            const uint16_t width = job->slab[k].width;

            for (int i = 0; i < lanes; i++) {
                const ptrdiff_t q =
                    i / RF_TILE * job->stride + i % RF_TILE + job->offset[k][n];

                value[i] = (uint16_t)(job->blur[q] - low) <= width ? job->light[q] : value[i];
            }
        }
        for (int i = 0; i < lanes; i++)
            sum[i] += value[i];
    }
}
