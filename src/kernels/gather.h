/* gather.h: contracts of the sweeps, which add up what the rays of a tile see. */
#ifndef RF_KERNELS_GATHER_H
#define RF_KERNELS_GATHER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/rays.h"

/*
 * sweep: rays of one strip.
 *
 *     for each ray n and pixel p of the strip:
 *         for t = 0 .. tests[n] - 1:
 *             q = p + offset[t][n]
 *             if rf_in_range(from[t][n], to[t][n], blur[q]):
 *                 sum += light[q]; next ray
 *         sum += last[n][p]
 *
 * Light is at most 65535 / steps; sums are exact. Pointers are to the strip's first pixel.
 * Where sum[3] is not NULL, the weights of what is hit are added up there: no more than that, and
 * lying as those of sweep_weighted.
 */
/* Light that highlights reach: white, 4, 8 or 16 times that. */
enum rf_bright { RF_WHITE, RF_BRIGHT, RF_BRIGHTER, RF_BRIGHTEST };

struct rf_sweep_job {
    const int16_t *blur;     /* light is in the three planes after it, pitch apart */
    ptrdiff_t stride, pitch; /* elements */
    const struct rf_sorted_rays *rays;
    int steps;             /* of sweep: values that a 16-bit sum holds, 1 to 16 */
    enum rf_bright bright; /* of sweep_weighted */
    int lanes;             /* those of an even number of rows, of RF_STRIP at most */

    /* weights of the front, 1 to RF_WEIGHT_MAX in sweep_weighted */
    const uint16_t *weight;
    ptrdiff_t weight_stride;
};
typedef void rf_sweep_fn(uint32_t *const sum[4], const struct rf_sweep_job *job);

/* sweep_weighted: the same, where light, Q12 up to `bright`, counts weight times; sum[3] is that
 * of weights. Those of the front lie in a plane with a stride of its own, those of the background
 * as its light. Never RF_BRIGHTEST but for the reference. */
enum { RF_WEIGHT_MAX = 32767 };
typedef void rf_sweep_weighted_fn(uint64_t *const sum[4], const struct rf_sweep_job *job);

/*
 * sweep1: as sweep, of one plane and of some rows of a tile: those of the first half `apart`
 * elements apart, those of the second as far, from `half` elements after the first row on.
 * Light is at most 65535 / steps; sums are exact. `last` of the rays is in that plane. Of chroma
 * only rays that are shared count, with its offsets and its last, and blurs come twice.
 */
struct rf_sweep1_job {
    const int16_t *blur;
    const uint16_t *light;
    ptrdiff_t apart, half;
    int rows;  /* an even number, 16 at most */
    int steps; /* values that a 16-bit sum holds, 4 to 16 */
    bool chroma;
    const struct rf_sorted_rays *rays;

    const uint16_t *weight; /* of the tile's first pixel; at most 4095 but for sweep1_weighted */
    int down;               /* rows of weights are 1 << down times as far apart */
};

/* With weight_sum, not NULL, the weights of what is hit are added up there: no more than that, and
 * lying as those of sweep1_weighted. */
typedef void rf_sweep1_fn(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job);

/* sweep1_weighted: the same, where light counts weight times, 1 to RF_WEIGHT_MAX, and sums of
 * weights. Those of luma lie as its light; elements 2 i and 2 i + 1 of chroma count as the pixel
 * of the first, at chroma_weight_offset. */
typedef void rf_sweep1_weighted_fn(uint64_t *sum, uint64_t *weight,
                                   const struct rf_sweep1_job *job);

#endif
