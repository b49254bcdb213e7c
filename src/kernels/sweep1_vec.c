/* sweep1_vec.c: sums of what the rays of a tile see, some vectors at a time; sweep_planes_vec.h has
 * the loops. */
#include "kernels/sweep_planes_vec.h"

void RF_VEC(rf_sweep1)(uint32_t *sum, const struct rf_sweep1_job *job)
{
    const struct rf_sweep_view view = rf_sweep1_view(job);

    rf_sweep_planes_vec(&sum, &view, 1);
}
