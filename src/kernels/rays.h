/* rays.h: contracts of the kernels that find where rays look, and what they need not test. */
#ifndef RF_KERNELS_RAYS_H
#define RF_KERNELS_RAYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/ranges.h"
#include "tiles/slab.h"

/* Rays of a tile are a chunk at a time. */
enum { RF_RAY_CHUNK = 64 };

/* aim: where n rays see the blur s: x = round(u s), y = round(v s), half up, as an offset
 * x + y stride, and as one of cells: floor(x / RF_CELL) + floor(y / RF_CELL) cell_stride. */
typedef void rf_aim_fn(int32_t *offset, int32_t *cell, const int16_t *u, const int16_t *v, int blur,
                       int32_t stride, int32_t cell_stride, int n);

/*
 * aim_chroma: offsets, as aim, of samples of chroma that are two pixels apart across and 1 << down
 * of them down, two elements of a row each: 2 x + y stride, x = round(u s / 2) and
 * y = round(v s / 2^down); of their pixels: 2 x + 2^down y stride.
 */
typedef void rf_aim_chroma_fn(int32_t *offset, int32_t *pixel, const int16_t *u, const int16_t *v,
                              int blur, int down, int32_t stride, int n);

/*
 * sort_rays: what the rays of a strip have to look at.
 *
 *     for each ray n:
 *         for k = 0 .. slabs - 1, with the range at range[cell[k][n]]:
 *             no blur in the range is in slab k: go on
 *             all blurs are:                     take its light as the last, offset[k][n]; end
 *             none is deeper, and it is bare:    the last is the background at offset[k][n]; end
 *             else:                              test slab k at offset[k][n]
 *         the last is the background at offset[slabs][n]
 *
 * Slabs k - 1 and k that are both to be tested at one offset are one test of all from the
 * former's low to the latter's end, where the slabs overlap or touch (joined[k]); and the last
 * test is left out where a slab's light is the last and it was tested in slab k - 1 at the same
 * offset. This does not go across multiples of RF_JOIN_BLOCK.
 *
 * Rays come out with fewer tests first, those of RF_SORTED_TESTS - 1 or more at the end, and
 * otherwise in their order. Nothing is lost by all this: tests that are left out could not hit,
 * would all hit, or lead to the same light. Only where `beneath` is set are deepest slabs that are
 * bare not tested: what is in the slab has the same light in the background, and what is not is
 * nearer and was not met, so that the ray passes beneath it, most likely to this slab. A third of
 * all tests is of that kind. Slabs wider than the least rf_bare_depth() of their blurs are tested.
 */
enum { RF_SORTED_TESTS = 8, RF_JOIN_BLOCK = 16 };

struct rf_sort_job {
    const uint32_t *range;          /* at the strip's first pixel, */
    const uint32_t *below;          /* and at that of the strip below, if both are one; else NULL */
    const uint16_t *front, *behind; /* first of three planes of light, there */
    const uint16_t *weight, *behind_weight; /* for sweep_weighted, else NULL: see there */
    int rays, slabs;
    bool beneath;
    const struct rf_slab *slab;
    const bool *joined;                                           /* [slabs]: slab k to k - 1 */
    const int32_t (*offset)[RF_RAY_CHUNK], (*cell)[RF_RAY_CHUNK]; /* [slabs + 1], [slabs] */
    const int32_t (*weight_offset)[RF_RAY_CHUNK];                 /* [slabs] */

    /* Rays 0 to shared - 1 are those of chroma, too, with planes and offsets of its own, and of the
     * same weights. What a ray of luma need not look for in a whole tile, chroma need not, either:
     * round(u s / 2) samples are at most a pixel from round(u s), and ranges are of whole
     * cells, which begin at even pixels. */
    int shared;
    const int32_t (*chroma_offset)[RF_RAY_CHUNK], (*chroma_weight_offset)[RF_RAY_CHUNK];
    const uint16_t *chroma_front, *chroma_behind;
};

struct rf_sorted_rays {
    int rays;
    uint8_t tests[RF_RAY_CHUNK];
    uint8_t begin[RF_SORTED_TESTS + 1]; /* ray that those of so many tests begin at; `rays` */
    /* Test t, nearest first, at offset[t], hits where rf_in_range(from[t], to[t], blur). */
    int32_t offset[RF_BINS][RF_RAY_CHUNK];
    uint16_t from[RF_BINS][RF_RAY_CHUNK], to[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last[RF_RAY_CHUNK]; /* first of three planes, for the strip's first pixel */

    /* Only with weights: as `offset` and `last`, of the weights. */
    int32_t weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last_weight[RF_RAY_CHUNK];
    bool last_behind[RF_RAY_CHUNK]; /* which plane last_weight is in */

    /* How many of those with so many tests are shared: the first ones, for which, as `offset` and
     * `last`, of chroma: */
    uint8_t shared[RF_SORTED_TESTS];
    int32_t chroma_offset[RF_BINS][RF_RAY_CHUNK], chroma_weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *chroma_last[RF_RAY_CHUNK], *chroma_last_weight[RF_RAY_CHUNK];
};
typedef void rf_sort_rays_fn(struct rf_sorted_rays *sorted, const struct rf_sort_job *job);

#endif
