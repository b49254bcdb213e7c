/* sweep_weighted_vec.c: weighted sums of what the rays of a strip see, of three planes, one vector
 * at a time; sweep_weighted_planes_vec.h has the loops. */
#include "kernels/sweep_weighted_planes_vec.h"

enum { STEPS = 32 }; /* rays that a 32-bit sum holds: 32 * 4095 * 32767 < 2^32 */

/* Rays that it holds of light 4 and 8 times as bright. Products of two are added signed:
 * 2 * 8 * 4095 * 32767 < 2^31. */
static const uint8_t steps_of[] = {
    [RF_WHITE] = STEPS, [RF_BRIGHT] = STEPS / 4, [RF_BRIGHTER] = STEPS / 8};

void RF_VEC(rf_sweep_weighted)(uint64_t *const sum[4], const struct rf_sweep_job *job)
{
    const struct rf_sweep_view view = rf_sweep_view(job);

    rf_sweep_weighted_planes_vec(sum, &view, steps_of[job->bright], 3, 1);
}
