/* rays.h: contracts of the kernels that find where rays look, and what they need not test. */
#ifndef RF_KERNELS_RAYS_H
#define RF_KERNELS_RAYS_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/ranges.h"
#include "kernels/slab.h"

/* The rays of a tile are worked on in chunks. */
enum { RF_RAY_CHUNK = 64 };

/* Whether a blur lies in a slab is found modulo 2^16 (kernels/slab.h): two blurs differ by twice
 * 127 pixels at the most, so what lies outside of a slab of 480 is never mistaken for inside. */
static_assert(UINT16_MAX + 1 - 2 * 127 * 256 > 480, "slabs are told apart modulo 2^16");

/* aim: where n rays see the blur s, Q7.8 of 2^unit pixels, unit 0 to RF_MAX_UNIT: x = round(u s), y
 * = round(v s), half up, as an offset x + y stride, and as one of cells: floor(x / RF_CELL) +
 * floor(y / RF_CELL) cell_stride. */
typedef void rf_aim_fn(int32_t *offset, int32_t *cell, const int16_t *u, const int16_t *v, int blur,
                       int unit, int32_t stride, int32_t cell_stride, int n);

/*
 * aim_chroma: where n rays see the blur s, as aim says, in samples of chroma that are two pixels
 * apart across and 1 << down of them down, two elements of a row each: 2 x + y stride, x = round(u
 * s / 2) and y = round(v s / 2^down); of their pixels: 2 x + 2^down y stride.
 */
typedef void rf_aim_chroma_fn(int32_t *offset, int32_t *pixel, const int16_t *u, const int16_t *v,
                              int blur, int unit, int down, int32_t stride, int n);

/*
 * sort_rays: culls the tests that the rays of a strip need not make.
 *
 *     for each ray n:
 *         for k = 0 .. slabs - 1, with the range at range[cell[k][n]]:
 *             no blur in the range is in slab k: go on
 *             all blurs are in it:               the last is its light at offset[k][n]; end
 *             *             none is deeper, and the range is
 *             RF_IN_BACKGROUND:                  the last is the background at offset[k][n]; end
 *             else:                              test slab k at offset[k][n]
 *         the last is the background at offset[slabs][n]
 *
 * An example: slab 0 holds blurs 1024 to 1280, slab 1 holds 512 to 1100, slab 2 holds -64 to 600. A
 * ray sees slab 0 where blurs are 20 to 300: none lies in it, and the ray goes on. It sees slab 1
 * where blurs are 30 to 900: some lie in it, and that is one test. It sees slab 2 where blurs are
 * 40 to 200: all lie in it, and its light there is the last. So one test is left of three. Had the
 * range at slab 0 been 1030 to 1200, the ray would need no test at all.
 *
 * Two slabs k - 1 and k that are both to be tested at one offset are merged to one test, from the
 * former's low to the latter's end, where they overlap or touch (joined[k]). The last test is left
 * out where a slab's light is the last and slab k - 1 was to be tested at the same offset. Tests
 * are not merged across multiples of RF_JOIN_BLOCK.
 *
 * Rays come out with fewer tests first, those of RF_SORTED_TESTS - 1 or more at the end, and
 * otherwise in their order. Tests that are culled could not hit, would all hit, or lead to the same
 * light, so nothing changes by that. There is one exception: where `skip_deepest` is set, the
 * deepest slab is not tested if it is in the background layer too. Pixels in this slab have the
 * same light there. Others are nearer and were not hit, so the ray passes them and hits a surface
 * that they occlude, most likely one of this slab. A third of all tests is of that kind. Slabs
 * wider than the least rf_background_depth() of their blurs are tested.
 */
enum { RF_SORTED_TESTS = 8, RF_JOIN_BLOCK = 16 };

struct rf_sort_job {
    const uint32_t *range;                      /* at the strip's first pixel */
    const uint32_t *below;                      /* at the strip below, if both are one; else NULL */
    const uint16_t *front, *background;         /* first of three planes of light, there */
    const uint16_t *weight, *background_weight; /* for sweep_weighted, else NULL: see there */
    int rays, slabs;
    bool skip_deepest;
    const struct rf_slab *slab;
    const bool *joined;                                           /* [slabs]: slab k to k - 1 */
    const int32_t (*offset)[RF_RAY_CHUNK], (*cell)[RF_RAY_CHUNK]; /* [slabs + 1], [slabs] */
    const int32_t (*weight_offset)[RF_RAY_CHUNK];                 /* [slabs] */

    /* Chroma shares rays 0 to shared - 1, with planes and offsets of its own, and the same weights.
     * Slabs that a ray of luma need not test in a whole tile, it need not test in chroma, either:
     * round(u s / 2) samples are at most a pixel from round(u s), and ranges are of whole
     * cells, which begin at even pixels. */
    int shared;
    const int32_t (*chroma_offset)[RF_RAY_CHUNK], (*chroma_weight_offset)[RF_RAY_CHUNK];
    const uint16_t *chroma_front, *chroma_background;
};

struct rf_sorted_rays {
    int rays;
    bool past_slabs; /* The last light of some ray is that at offset[slabs]. */
    uint8_t tests[RF_RAY_CHUNK];
    uint8_t begin[RF_SORTED_TESTS + 1]; /* ray that those of so many tests begin at; `rays` */
    /* Test t, nearest first, at offset[t], hits where rf_in_range(from[t], to[t], blur). */
    int32_t offset[RF_BINS][RF_RAY_CHUNK];
    uint16_t from[RF_BINS][RF_RAY_CHUNK], to[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last[RF_RAY_CHUNK]; /* first of three planes, for the strip's first pixel */

    /* Where the weights lie, like `offset` and `last`; only set if there are weights. */
    int32_t weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last_weight[RF_RAY_CHUNK];
    bool last_is_background[RF_RAY_CHUNK]; /* last_weight is in the background */

    /* How many of the rays with so many tests chroma shares, the first ones; and for these, like
     * `offset` and `last`, where its samples and weights lie. */
    uint8_t shared[RF_SORTED_TESTS];
    int32_t chroma_offset[RF_BINS][RF_RAY_CHUNK], chroma_weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *chroma_last[RF_RAY_CHUNK], *chroma_last_weight[RF_RAY_CHUNK];
};
typedef void rf_sort_rays_fn(struct rf_sorted_rays *sorted, const struct rf_sort_job *job);

#endif
