/* sweep1_vec.c: sums of what the rays of a tile see, some vectors at a time; sweep_planes_vec.h has
 * the loops. */
#include "kernels/sweep_planes_vec.h"

void RF_VEC(rf_sweep1)(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job)
{
    const struct rf_sweep_view view = rf_sweep1_view(job);
    uint32_t *const sums[2] = {sum, weight_sum};

    if (weight_sum)
        rf_sweep_planes_vec(sums, &view, 1, true);
    else
        rf_sweep_planes_vec(sums, &view, 1, false);
}
