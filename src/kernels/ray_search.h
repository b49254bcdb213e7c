/* ray_search.h: contracts of the randomized intersection search. */
#ifndef RF_KERNELS_RAY_SEARCH_H
#define RF_KERNELS_RAY_SEARCH_H

#include <stddef.h>
#include <stdint.h>

#include "kernels/rays.h"

/*
 * search: follows the rays of one strip by the randomized intersection search, and sums their
 * light.
 *
 *     for each ray and pixel p of the tile:
 *         guess = blur[p + start]
 *         repeat: q = p + round(u guess), seen = blur[q], until |seen - guess| <= within or
 *                 `tests` are made; guess = seen before each further one
 *         sum += light[q], or light[p] if the last test failed and seen > blur[p]
 *
 * round() is half up, of Q15 times Q7.8. Pointers are to the strip's first pixel.
 */
struct rf_search_rays {
    int rays;
    int32_t start[RF_RAY_CHUNK];              /* elements */
    int16_t u[RF_RAY_CHUNK], v[RF_RAY_CHUNK]; /* Q15 */
    int32_t within[RF_RAY_CHUNK];             /* Q7.8, 0 to 32766 */
};
struct rf_search_job {
    const int16_t *blur;
    const uint16_t *light[3];
    ptrdiff_t stride; /* at most 2^20 */
    int tests;
    const struct rf_search_rays *rays;
};
typedef void rf_search_fn(uint32_t *const sum[3], const struct rf_search_job *job);

/* tolerances: the largest |s - s'| that half a pixel allows a ray: 1/2 / |u|, in Q7.8, rounded
 * down; at most 32766, which is short of it only where u s rounds to 0 for all s. */
typedef void rf_tolerances_fn(int32_t *within, const int16_t *u, const int16_t *v, int n);

/*
 * settle: which of some rays the first test of a search settles for a whole strip: those whose
 * first guesses all lead the same way, to blurs that, by the ranges there (windows, above),
 * confirm them all or, in a search of one test, lie nowhere above those of the strip.
 * settled[i] tells, 1 or 0, and then offset[i] is where the light is. `range` is at the
 * strip's first pixel, cell[i] the offset of the first guesses; a stride is at most 2^20.
 */
typedef void rf_settle_fn(uint8_t *settled, int32_t *offset, const uint32_t *range,
                          const int32_t *cell, const struct rf_search_rays *rays, int tests,
                          int32_t stride, int32_t cell_stride);

#endif
