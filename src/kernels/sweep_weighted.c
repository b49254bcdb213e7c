/* sweep_weighted.c: weighted sums of what the rays of a strip see, of three planes. */
#include "kernels/sweep_planes.h"

void rf_sweep_weighted_c(uint64_t *const sum[4], const struct rf_sweep_job *job)
{
    const struct rf_sweep_view view = rf_sweep_view(job);

    rf_sweep_weighted_planes(sum, &view, 3);
}
