/* search.c: follows rays by the randomized intersection search, and sums their light. */
#include "kernels/kernels.h"

static inline int32_t offset_of(int u, int v, int blur, int32_t stride)
{
    return ((v * blur + (1 << 22)) >> 23) * stride + ((u * blur + (1 << 22)) >> 23);
}

/* Where the light of ray n of the pixel at `blur` comes from. */
static int32_t search(const struct rf_search_job *job, int n, const int16_t *blur)
{
    const struct rf_search_rays *rays = job->rays;
    const int within = rays->within[n];
    int seen = blur[rays->start[n]];

    for (int test = 1;; test++) {
        const int guess = seen;
        const int32_t q = offset_of(rays->u[n], rays->v[n], guess, (int32_t)job->stride);

        seen = blur[q];
        if (seen - guess <= within && guess - seen <= within)
            return q;
        if (test == job->tests)
            return seen > blur[0] ? 0 : q;
    }
}

void rf_search_c(uint32_t *const sum[3], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i++) {
        const ptrdiff_t p = i / RF_TILE * job->stride + i % RF_TILE;

        for (int n = 0; n < job->rays->rays; n++) {
            const int32_t q = search(job, n, job->blur + p);

            for (int c = 0; c < 3; c++)
                sum[c][i] += job->light[c][p + q];
        }
    }
}
