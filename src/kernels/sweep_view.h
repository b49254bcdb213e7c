/* sweep_view.h: one view of the jobs of all sweeps, of one and of three planes, for their
 * templates.
 *
 * sweep and sweep_weighted work on three planes of a strip, sweep1 and sweep1_weighted on one plane
 * of some rows of a tile. The templates sweep_planes.h and sweep_planes_vec.h read this view, and
 * take the number of planes as a constant.
 */
#ifndef RF_KERNELS_SWEEP_VIEW_H
#define RF_KERNELS_SWEEP_VIEW_H

#include "kernels/kernels.h"

/* Rows of a plane: those of the first half lie `apart` elements apart, those of the second as far,
 * from `half` elements after the first row on. */
struct rf_row_layout {
    ptrdiff_t apart, half;
};

struct rf_sweep_view {
    const struct rf_sorted_rays *rays;
    int rows, steps;
    bool chroma; /* elements 2 i and 2 i + 1 have the weight of element 2 i */

    const uint16_t *blur, *light; /* light of the first plane; the others lie `pitch` apart */
    ptrdiff_t pitch;
    struct rf_row_layout layout;
    const int32_t (*offset)[RF_RAY_CHUNK];
    const uint16_t *const *last;

    const uint16_t *weight;
    struct rf_row_layout weight_layout;
    const int32_t (*weight_offset)[RF_RAY_CHUNK];
    const uint16_t *const *last_weight;
};

static inline struct rf_sweep_view rf_sweep_view(const struct rf_sweep_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const int rows = job->lanes / RF_TILE;
    return (struct rf_sweep_view){
        .rays = rays,
        .rows = rows,
        .steps = job->steps,
        .blur = (const uint16_t *)job->blur,
        .light = (const uint16_t *)job->blur + job->pitch,
        .pitch = job->pitch,
        .layout = {job->stride, rows / 2 * job->stride},
        .offset = (const int32_t(*)[RF_RAY_CHUNK])rays->offset,
        .last = (const uint16_t *const *)rays->last,
        .weight = job->weight,
        .weight_layout = {job->weight_stride, rows / 2 * job->weight_stride},
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])rays->weight_offset,
        .last_weight = (const uint16_t *const *)rays->last_weight,
    };
}

static inline struct rf_sweep_view rf_sweep1_view(const struct rf_sweep1_job *job)
{
    const struct rf_sorted_rays *rays = job->rays;
    const bool chroma = job->chroma;
    return (struct rf_sweep_view){
        .rays = rays,
        .rows = job->rows,
        .steps = job->steps,
        .chroma = chroma,
        .blur = (const uint16_t *)job->blur,
        .light = job->light,
        .layout = {job->apart, job->half},
        .offset = (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_offset : rays->offset),
        .last = (const uint16_t *const *)(chroma ? rays->chroma_last : rays->last),
        .weight = job->weight,
        .weight_layout = {job->apart * (1 << job->down), job->half * (1 << job->down)},
        .weight_offset =
            (const int32_t(*)[RF_RAY_CHUNK])(chroma ? rays->chroma_weight_offset : rays->offset),
        .last_weight =
            (const uint16_t *const *)(chroma ? rays->chroma_last_weight : rays->last_weight),
    };
}

/* Rays first to end - 1, all of `tests` tests, or of as many as have no loop of their own. */
struct rf_ray_run {
    int first, end, tests;
};

/* The run of rays after `run`, which begins as {0, 0, -1}; false: there is none. Rays of three
 * planes lie in any order. Those of one plane lie by their tests, and of chroma only the first of
 * each class count. */
static RF_ALWAYS_INLINE bool rf_next_run(struct rf_ray_run *run, const struct rf_sweep_view *v,
                                         const int planes)
{
    const struct rf_sorted_rays *rays = v->rays;

    if (planes > 1) {
        const int first = run->end;

        if (first == rays->rays)
            return false;
        *run = (struct rf_ray_run){first, first + 1, rays->tests[first]};
        while (run->end < rays->rays && rays->tests[run->end] == run->tests)
            run->end++;
        return true;
    }
    while (++run->tests < RF_SORTED_TESTS) {
        run->first = rays->begin[run->tests];
        run->end = v->chroma ? run->first + rays->shared[run->tests] : rays->begin[run->tests + 1];
        if (run->end > run->first)
            return true;
    }
    return false;
}

#endif
