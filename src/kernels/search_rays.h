/* search_rays.h: the template of the searches in plain C: what the ray of one pixel sees. */
#ifndef RF_KERNELS_SEARCH_RAYS_H
#define RF_KERNELS_SEARCH_RAYS_H

#include "colour/transfer.h"
#include "kernels/kernels.h"
#include "kernels/lanes.h"

/* An offset in pixels. */
struct rf_step {
    int x, y;
};

static inline struct rf_step rf_step_of(const struct rf_search_rays *rays, int n, int blur)
{
    return (struct rf_step){(rays->u[n] * blur + (1 << 22)) >> 23,
                            (rays->v[n] * blur + (1 << 22)) >> 23};
}

/* Light that a ray sees, and its weight. */
struct rf_search_hit {
    uint16_t light[3], weight;
};

/* Pixel (x, y) of the strip. */
static RF_ALWAYS_INLINE struct rf_search_hit rf_front_at(const struct rf_search_job *job, int x,
                                                         int y, const bool weighted)
{
    const ptrdiff_t q = y * job->stride + x;

    return (struct rf_search_hit){
        {job->light[0][q], job->light[1][q], job->light[2][q]},
        weighted ? job->weight[y * job->weight_stride + x] : 0,
    };
}

static RF_ALWAYS_INLINE struct rf_search_hit rf_background_at(const struct rf_search_job *job,
                                                              int x, int y, const bool weighted)
{
    const ptrdiff_t q = y * job->stride + x;
    const uint16_t r = job->background[0][q], g = job->background[1][q], b = job->background[2][q];
    const uint16_t most = job->first_weighs ? r : rf_most16(r, rf_most16(g, b));

    return (struct rf_search_hit){{r, g, b},
                                  weighted ? job->light_weight[rf_least16(most, RF_LIGHT_MAX)] : 0};
}

/* The hit of ray n of pixel (x, y) where it is hidden, after the guess `last`. */
static RF_ALWAYS_INLINE struct rf_search_hit
rf_hidden_at(const struct rf_search_job *job, int n, int x, int y, int last, const bool weighted)
{
    struct rf_step step = {0, 0};

    if (job->fallback == RF_FALLBACK_BACKGROUND) {
        step = rf_step_of(job->rays, n, job->background_blur[y * job->stride + x]);
        return rf_background_at(job, x + step.x, y + step.y, weighted);
    }
    if (job->fallback == RF_FALLBACK_MIRRORED)
        step = rf_step_of(job->rays, n, last);
    return rf_front_at(job, x - step.x, y - step.y, weighted);
}

/* The hit of ray n of pixel (x, y). */
static RF_ALWAYS_INLINE struct rf_search_hit rf_search_ray(const struct rf_search_job *job, int n,
                                                           int x, int y, const bool weighted)
{
    const int16_t *const blur = job->blur + (y * job->stride + x);
    const int within = job->rays->within[n];
    int seen = blur[job->rays->start[n]];

    for (int test = 1;; test++) {
        const int guess = seen;
        const struct rf_step step = rf_step_of(job->rays, n, guess);

        seen = blur[step.y * job->stride + step.x];
        if (seen - guess <= within && guess - seen <= within)
            return rf_front_at(job, x + step.x, y + step.y, weighted);
        if (test == job->tests)
            return seen > blur[0] ? rf_hidden_at(job, n, x, y, guess, weighted)
                                  : rf_front_at(job, x + step.x, y + step.y, weighted);
    }
}

#endif
