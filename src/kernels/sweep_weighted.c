#include "kernels/kernels.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

/* Whether ray n of pixel i, not yet at an end, meets slab k; then it is added. */
static bool meets(uint64_t sum[4][LANES], const struct rf_sweep_job *job, int i, int k, int n)
{
    const ptrdiff_t x = i % RF_TILE, y = i / RF_TILE;
    const int16_t *const q = job->blur + y * job->stride + x + job->offset[k][n];
    const uint64_t w = job->weight[y * job->weight_stride + x + job->weight_offset[k][n]];

    if ((uint16_t)(*q - job->slab[k].low) > job->slab[k].width)
        return false;
    for (int c = 0; c < 3; c++)
        sum[c][i] += w * (uint16_t)q[(1 + c) * job->pitch];
    sum[3][i] += w;
    return true;
}

static void look_behind(uint64_t sum[4][LANES], const struct rf_sweep_job *job, int i, int n)
{
    const ptrdiff_t q =
        i / RF_TILE * job->stride + i % RF_TILE + job->offset[job->slabs][n];
    const uint64_t w = job->behind_weight[q];

    for (int c = 0; c < 3; c++)
        sum[c][i] += w * job->behind[q + c * job->pitch];
    sum[3][i] += w;
}

void rf_sweep_weighted_c(uint64_t sum[4][LANES], const struct rf_sweep_job *job)
{
    for (int i = 0; i < LANES; i++) {
        for (int n = 0; n < job->rays; n++) {
            int k = 0;

            while (k < job->slabs && !meets(sum, job, i, k, n))
                k++;
            if (k == job->slabs)
                look_behind(sum, job, i, n);
        }
    }
}
