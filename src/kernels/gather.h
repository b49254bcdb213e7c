/* gather.h: contracts of the sweeps, which add up what the rays of a tile see. */
#ifndef RF_KERNELS_GATHER_H
#define RF_KERNELS_GATHER_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "colour/transfer.h"
#include "colour/yuv.h"
#include "kernels/rays.h"

/*
 * sweep: adds up what the rays of one strip see, nearest surface first.
 *
 *     for each ray n and pixel p of the strip:
 *         for t = 0 .. tests[n] - 1:
 *             q = p + offset[t][n]
 *             if rf_in_range(from[t][n], to[t][n], blur[q]):
 *                 sum += light[q]; next ray
 *         sum += last[n][p]
 *
 * Light is at most 65535 / steps, and sums are exact. Pointers are to the strip's first pixel.
 *
 * An example: a ray has two tests, blurs 1024 to 1280 at q = p + 3 and 512 to 800 at q = p + 2. A
 * pixel finds blur 60 at p + 3, which misses, and 700 at p + 2, which hits: light[p + 2] is added,
 * and the ray ends. Had both missed, last[n][p] would be added.
 */
/* The brightest light that highlights reach: white, or 4, 8 or 16 times that. */
enum rf_bright { RF_WHITE, RF_BRIGHT, RF_BRIGHTER, RF_BRIGHTEST };

struct rf_sweep_job {
    const int16_t *blur;     /* light is in the three planes after it, pitch apart */
    ptrdiff_t stride, pitch; /* elements */
    const struct rf_sorted_rays *rays;
    int steps;             /* how many values a 16-bit sum of sweep holds, 1 to 16 */
    enum rf_bright bright; /* the light of sweep_weighted */
    int lanes;             /* all of an even number of rows, RF_STRIP at most */

    /* for sweep_weighted: weights of the front, 1 to RF_WEIGHT_MAX */
    const uint16_t *weight;
    ptrdiff_t weight_stride;
};
typedef void rf_sweep_fn(uint32_t *const sum[3], const struct rf_sweep_job *job);

static_assert(16 * RF_LIGHT_MAX <= UINT16_MAX, "16 rays of light up to white fit 16 bits");
static_assert(8 * RF_CHROMA_MAX <= UINT16_MAX, "8 rays of chroma fit 16 bits");

/* sweep_weighted: a sweep in which light, Q12 up to `bright`, counts weight times; sum[3] is the
 * sum of weights. The weights of the front lie in a plane with a stride of its own, those of the
 * background as its light. Only the reference takes RF_BRIGHTEST. */
typedef void rf_sweep_weighted_fn(uint64_t *const sum[4], const struct rf_sweep_job *job);

/*
 * sweep1: a sweep of one plane, at some rows of a tile. The rows of the first half lie `apart`
 * elements apart, those of the second as far, from `half` elements after the first row on. Light is
 * at most 65535 / steps, and sums are exact. `last` of the rays is in that plane. In chroma only
 * the shared rays count, with its own offsets and its own last, and each blur comes twice.
 */
struct rf_sweep1_job {
    const int16_t *blur;
    const uint16_t *light;
    ptrdiff_t apart, half;
    int rows;  /* an even number, 16 at most */
    int steps; /* values that a 16-bit sum holds, 4 to 16 */
    bool chroma;
    const struct rf_sorted_rays *rays;

    const uint16_t *weight; /* for sweep1_weighted: at the tile's first pixel */
    int down;               /* rows of weights are 1 << down times as far apart */
};

typedef void rf_sweep1_fn(uint32_t *sum, const struct rf_sweep1_job *job);

/* sweep1_weighted: sweep1 with light that counts weight times, 1 to RF_WEIGHT_MAX, and sums of
 * weights. The weights of luma lie as its light; elements 2 i and 2 i + 1 of chroma count as the
 * pixel of the first, at chroma_weight_offset. */
typedef void rf_sweep1_weighted_fn(uint64_t *sum, uint64_t *weight,
                                   const struct rf_sweep1_job *job);

#endif
