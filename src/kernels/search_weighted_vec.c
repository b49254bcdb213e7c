/* search_weighted_vec.c: follows rays by the randomized intersection search and sums their light
 * by its weights; search_rays_vec.h has the loops. */
#include "kernels/search_rays_vec.h"

void RF_VEC(rf_search_weighted)(uint64_t *const sum[4], const struct rf_search_job *job)
{
    rf_search_strip_vec(NULL, sum, job, true);
}
