/* search_weighted.c: follows rays by the randomized intersection search, and sums their light by
 * its weights. */
#include "kernels/search_rays.h"

void rf_search_weighted_c(uint64_t *const sum[4], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i++) {
        for (int n = 0; n < job->rays->rays; n++) {
            const struct rf_search_hit hit = rf_search_ray(job, n, i % RF_TILE, i / RF_TILE, true);

            for (int c = 0; c < 3; c++)
                sum[c][i] += (uint64_t)hit.weight * hit.light[c];
            sum[3][i] += hit.weight;
        }
    }
}
