/* search_vec.c: follows rays by the randomized intersection search and sums their light;
 * search_rays_vec.h has the loops. */
#include "kernels/search_rays_vec.h"

void RF_VEC(rf_search)(uint32_t *const sum[3], const struct rf_search_job *job)
{
    rf_search_strip_vec(sum, NULL, job, false);
}
