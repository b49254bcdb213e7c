/* sweep_vec.c: sums of what the rays of a strip see, some vectors at a time; sweep_planes_vec.h has
 * the loops. */
#include "kernels/sweep_planes_vec.h"

void RF_VEC(rf_sweep)(uint32_t *const sum[3], const struct rf_sweep_job *job)
{
    const struct rf_sweep_view view = rf_sweep_view(job);

    rf_sweep_planes_vec(sum, &view, 3);
}
