/* add_counted.c: adds up values as often as they were counted, of one row of a tile. */
#include "kernels/kernels.h"

void rf_add_counted_c(uint32_t (*sum)[RF_TILE], const struct rf_counted_job *job)
{
    for (int j = 0; j < job->planes; j++) {
        for (int k = 0; k < job->n; k++) {
            const uint16_t *const value = job->plane + j * job->pitch + job->number[k];
            const uint16_t *const count = job->count[job->number[k]];

            for (int i = 0; i < RF_TILE; i++)
                sum[j][i] += (uint32_t)count[i] * value[i];
        }
    }
}
