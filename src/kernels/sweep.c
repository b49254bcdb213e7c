/* sweep.c: sums of what the rays of a strip see, of three planes; sweep_planes.h has the loops. */
#include "kernels/sweep_planes.h"

void rf_sweep_c(uint32_t *const sum[3], const struct rf_sweep_job *job)
{
    const struct rf_sweep_view view = rf_sweep_view(job);

    rf_sweep_planes(sum, &view, 3);
}
