/* search.c: follows rays by the randomized intersection search, and sums their light. */
#include "kernels/search_rays.h"

void rf_search_c(uint32_t *const sum[3], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i++) {
        for (int n = 0; n < job->rays->rays; n++) {
            const struct rf_search_hit hit = rf_search_ray(job, n, i % RF_TILE, i / RF_TILE, false);

            for (int c = 0; c < 3; c++)
                sum[c][i] += hit.light[c];
        }
    }
}
