/* sweep1_weighted_vec.c: weighted sums of what the rays of a tile see, of one plane, two vectors at
 * a time; sweep_weighted_planes_vec.h has the loops. */
#include "colour/transfer.h"
#include "kernels/sweep_weighted_planes_vec.h"

#include <assert.h>

void RF_VEC(rf_sweep1_weighted)(uint64_t *sum, uint64_t *weight, const struct rf_sweep1_job *job)
{
    const struct rf_sweep_view view = rf_sweep1_view(job);
    uint64_t *const sums[2] = {sum, weight};

    /* 32-bit sums hold twice as many products with weights as 16-bit ones hold values. */
    static_assert((uint64_t)2 * UINT16_MAX * RF_WEIGHT_MAX <= UINT32_MAX, "as the sum is unsigned");
    static_assert((uint64_t)2 * 4 * RF_LIGHT_MAX * RF_WEIGHT_MAX <= INT32_MAX,
                  "two are added signed");
    rf_sweep_weighted_planes_vec(sums, &view, 2 * job->steps, 1, 2);
}
