/* sweep_weighted_vec.c: weighted sums of what the rays of a strip see, of three planes, one vector
 * at a time; sweep_weighted_planes_vec.h has the loops. */
#include "colour/transfer.h"
#include "kernels/sweep_weighted_planes_vec.h"

#include <assert.h>

enum { STEPS = 32 }; /* rays that a 32-bit sum holds */
static_assert((uint64_t)STEPS * RF_LIGHT_MAX * RF_WEIGHT_MAX <= UINT32_MAX,
              "as the sum is unsigned");
static_assert((uint64_t)2 * 8 * RF_LIGHT_MAX * RF_WEIGHT_MAX <= INT32_MAX, "two are added signed");

/* Rays that it holds of light 4 and 8 times as bright. */
static const uint8_t steps_of[] = {
    [RF_WHITE] = STEPS, [RF_BRIGHT] = STEPS / 4, [RF_BRIGHTER] = STEPS / 8};

void RF_VEC(rf_sweep_weighted)(uint64_t *const sum[4], const struct rf_sweep_job *job)
{
    const struct rf_sweep_view view = rf_sweep_view(job);

    rf_sweep_weighted_planes_vec(sum, &view, steps_of[job->bright], 3, 1);
}
