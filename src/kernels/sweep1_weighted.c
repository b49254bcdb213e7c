/* sweep1_weighted.c: weighted sums of what the rays of a tile see, of one plane. */
#include "kernels/sweep_planes.h"

void rf_sweep1_weighted_c(uint64_t *sum, uint64_t *weight, const struct rf_sweep1_job *job)
{
    const struct rf_sweep_view view = rf_sweep1_view(job);
    uint64_t *const sums[2] = {sum, weight};

    rf_sweep_weighted_planes(sums, &view, 1);
}
