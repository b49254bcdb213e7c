/* sweep1.c: sums of what the rays of a tile see, of one plane; sweep_planes.h has the loops. */
#include "kernels/sweep_planes.h"

void rf_sweep1_c(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const struct rf_sweep_view view = rf_sweep1_view(job);

    rf_sweep_planes(&sum, &view, 1);
}
