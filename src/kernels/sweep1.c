/* sweep1.c: the sweep of one plane, plainly and with weights. */
#include "kernels/kernels.h"

/* Where lane i is, elements from the first. */
static ptrdiff_t at(const struct rf_sweep1_job *job, int i)
{
    const int y = i / RF_TILE, half = job->rows / 2;

    return (y < half ? y * job->apart : job->half + (y - half) * job->apart) + i % RF_TILE;
}

/* End of the rays of a class of tests that count. */
static int end_of(const struct rf_sweep1_job *job, int class)
{
    const struct rf_sorted_rays *rays = job->rays;

    return job->chroma ? rays->begin[class] + rays->shared[class] : rays->begin[class + 1];
}

/* Light, and weight if not NULL, that ray n meets at lane i. */
static void meet(const struct rf_sweep1_job *job, int n, int i, uint16_t *light, uint16_t *weight)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int32_t(*const offset)[RF_RAY_CHUNK] =
        job->chroma ? (const int32_t(*)[RF_RAY_CHUNK])rays->chroma_offset
                    : (const int32_t(*)[RF_RAY_CHUNK])rays->offset;
    const int32_t(*const pixel)[RF_RAY_CHUNK] =
        job->chroma ? (const int32_t(*)[RF_RAY_CHUNK])rays->chroma_weight_offset
                    : (const int32_t(*)[RF_RAY_CHUNK])rays->offset;
    const int x = i % RF_TILE;
    const ptrdiff_t p = at(job, i);
    const ptrdiff_t own = (p - x) * (1 << job->down) + (job->chroma ? x & ~1 : x);

    for (int t = 0; t < rays->tests[n]; t++) {
        const ptrdiff_t q = p + offset[t][n];

        if (rf_in_range(rays->from[t][n], rays->to[t][n], job->blur[q])) {
            *light = job->light[q];
            if (weight)
                *weight = job->weight[own + pixel[t][n]];
            return;
        }
    }
    *light = (job->chroma ? rays->chroma_last : rays->last)[n][p];
    if (weight)
        *weight = (job->chroma ? rays->chroma_last_weight : rays->last_weight)[n][own];
}

static void sweep_ray(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job, int n)
{
    for (int i = 0; i < job->rows * RF_TILE; i++) {
        uint16_t light, weight;

        meet(job, n, i, &light, weight_sum ? &weight : NULL);
        sum[i] += light;
        if (weight_sum)
            weight_sum[i] += weight;
    }
}

void rf_sweep1_c(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;

    for (int class = 0; class < RF_SORTED_TESTS; class ++)
        for (int n = rays->begin[class]; n < end_of(job, class); n++)
            sweep_ray(sum, weight_sum, job, n);
}

void rf_sweep1_weighted_c(uint64_t *sum, uint64_t *weight_sum, const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;

    for (int class = 0; class < RF_SORTED_TESTS; class ++) {
        for (int n = rays->begin[class]; n < end_of(job, class); n++) {
            for (int i = 0; i < job->rows * RF_TILE; i++) {
                uint16_t light, weight;

                meet(job, n, i, &light, &weight);
                sum[i] += (uint64_t)weight * light;
                weight_sum[i] += weight;
            }
        }
    }
}
