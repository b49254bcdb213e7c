/* ray_search.h: contracts of the randomized intersection search. */
#ifndef RF_KERNELS_RAY_SEARCH_H
#define RF_KERNELS_RAY_SEARCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/rays.h"

/* The fallback of a ray whose last test failed, at a surface that lies behind its pixel. */
enum rf_fallback { RF_FALLBACK_OWN, RF_FALLBACK_MIRRORED, RF_FALLBACK_BACKGROUND };

/*
 * search: follows the rays of one strip by the randomized intersection search, and sums their
 * light.
 *
 *     for each ray and pixel p of the strip:
 *         guess = blur[p + start]
 *         repeat: q = p + round(u guess), seen = blur[q], until |seen - guess| <= within or
 *                 `tests` are made; guess = seen before each further one
 *         if the last test failed and seen > blur[p]:
 *             q = p                                     RF_FALLBACK_OWN
 *             q = p - round(u guess)                    RF_FALLBACK_MIRRORED
 *             q = p + round(u background blur[p]), of the background's light
 *         sum += light[q]
 *
 * round() is half up, of Q15 times Q7.8. Light is at most 65535 / steps. Pointers are to the
 * strip's first pixel.
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
    int steps; /* values that a sum of 16 bits, or of 32 bits if weighted, holds, 1 to 32 */
    const struct rf_search_rays *rays;

    enum rf_fallback fallback;
    const int16_t *background_blur; /* for RF_FALLBACK_BACKGROUND, with the same stride, */
    const uint16_t *background[3];  /* the light there */

    /* for search_weighted */
    const uint16_t *weight; /* weights of `light` */
    ptrdiff_t weight_stride;
    const uint16_t *light_weight; /* weights of each Q12 light, for the background */
    bool first_weighs;            /* light weighs as its first channel, not its brightest */
};
typedef void rf_search_fn(uint32_t *const sum[3], const struct rf_search_job *job);

/* search_weighted: a search in which light counts weight times, 1 to RF_WEIGHT_MAX; sum[3] is the
 * sum of weights. A pixel of the background weighs as its brightest channel or its first. Light
 * times weight is at most (2^32 - 1) / steps, and light below 2^15 where steps exceed 1. */
typedef void rf_search_weighted_fn(uint64_t *const sum[4], const struct rf_search_job *job);

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
