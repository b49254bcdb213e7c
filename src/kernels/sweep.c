#include "kernels/kernels.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

static void add_slab(uint32_t sum[3][LANES], uint16_t *is_free,
                     const struct rf_sweep_job *job, const struct rf_slab *slab,
                     ptrdiff_t offset)
{
    for (int i = 0; i < LANES; i++) {
        const ptrdiff_t q = i / RF_TILE * job->stride + i % RF_TILE + offset;
        const uint16_t above = (uint16_t)(job->blur[q] - slab->low);

        if (!is_free[i] || above > slab->width)
            continue;
        is_free[i] = 0;
        for (int c = 0; c < 3; c++)
            sum[c][i] += (uint16_t)job->blur[q + (1 + c) * job->pitch];
    }
}

void rf_sweep_c(uint32_t sum[3][LANES], const struct rf_sweep_job *job)
{
    uint16_t is_free[LANES];

    for (int n = 0; n < job->rays; n++) {
        memset(is_free, 0xff, sizeof is_free);
        for (int k = 0; k < job->slabs; k++)
            add_slab(sum, is_free, job, &job->slab[k], job->offset[k][n]);
        for (int i = 0; i < LANES; i++) {
            const ptrdiff_t q =
                i / RF_TILE * job->stride + i % RF_TILE + job->offset[job->slabs][n];

            if (is_free[i])
                for (int c = 0; c < 3; c++)
                    sum[c][i] += job->behind[q + c * job->pitch];
        }
    }
}
