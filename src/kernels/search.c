#include "kernels/kernels.h"

static inline int32_t offset_of(const struct rf_search_ray *ray, int blur, int32_t stride)
{
    return ((ray->v * blur + (1 << 22)) >> 23) * stride + ((ray->u * blur + (1 << 22)) >> 23);
}

/* Where the light of a ray of the pixel at `blur` comes from. */
static int32_t search(const struct rf_search_job *job, const struct rf_search_ray *ray,
                      const int16_t *blur)
{
    int seen = blur[ray->start];

    for (int test = 1;; test++) {
        const int guess = seen;
        const int32_t q = offset_of(ray, guess, (int32_t)job->stride);

        seen = blur[q];
        if (seen - guess <= ray->within && guess - seen <= ray->within)
            return q;
        if (test == job->tests)
            return seen > blur[0] ? 0 : q;
    }
}

void rf_search_c(uint32_t *const sum[3], const struct rf_search_job *job)
{
    for (int i = 0; i < RF_STRIP_LANES; i++) {
        const ptrdiff_t p = i / RF_TILE * job->stride + i % RF_TILE;

        for (int n = 0; n < job->rays; n++) {
            const int32_t q = search(job, &job->ray[n], job->blur + p);

            for (int c = 0; c < 3; c++)
                sum[c][i] += job->light[c][p + q];
        }
    }
}
