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

/*
 * Searches of many rays and one test count first and add up afterwards: rays that lie close to each
 * other hit the same pixel, whose light is then fetched once for all of them.
 *
 * count_hits: how often each pixel of a row of a tile sees the pixel at each offset, in planes
 * whose rows are RF_COUNT_ROW apart, so that the number of an offset is also where it leads.
 *
 *     for each ray n and pixel p of the row:
 *         guess = blur[p + start[n]], x = round(u guess), y = round(v guess)
 *         q = p + (x, y), seen = blur[q]
 *         if |seen - guess| <= within or seen <= blur[p]: count[number of (x, y)][p] += times[n]
 *         else:                                           count[number of (0, 0)][p] += times[n]
 *
 * Offsets are RF_COUNT_REACH at the most. touched[number] becomes 1 where a count may change.
 */
enum {
    RF_COUNT_REACH = 31,
    RF_COUNT_ROW = RF_TILE + 2 * RF_COUNT_REACH + 1, /* odd, so that counts spread over the cache */
    RF_COUNTS = RF_COUNT_ROW * (2 * RF_COUNT_REACH + 1),
    RF_COUNTED_RAYS = 1024,
};
static inline int rf_count_number(int x, int y)
{
    return (y + RF_COUNT_REACH) * RF_COUNT_ROW + x + RF_COUNT_REACH;
}
struct rf_counted_rays {
    int rays;
    int16_t start[RF_COUNTED_RAYS];                 /* elements */
    int16_t u[RF_COUNTED_RAYS], v[RF_COUNTED_RAYS]; /* Q15 */
    uint16_t within[RF_COUNTED_RAYS];               /* Q7.8, 0 to 32766 */
    uint16_t times[RF_COUNTED_RAYS];
};
typedef void rf_count_hits_fn(uint16_t (*count)[RF_TILE], uint8_t *touched, const int16_t *blur,
                              const struct rf_counted_rays *rays);

/*
 * add_counted: adds up what was counted, of some such planes of values below 2^15.
 *
 *     sum[j][p] += over k < n: count[number[k]][p] * plane j [number[k] + p]
 *
 * The counts of a pixel add up to less than 2^15, and their products to less than 2^32.
 */
enum { RF_COUNTED_PLANES = 7 };
struct rf_counted_job {
    const uint16_t (*count)[RF_TILE];
    const uint16_t *plane; /* the first of them, RF_COUNT_REACH above and beside the row */
    ptrdiff_t pitch;       /* elements from plane to plane */
    int planes;            /* RF_COUNTED_PLANES at the most */
    int n;
    const uint16_t *number;
};
typedef void rf_add_counted_fn(uint32_t (*sum)[RF_TILE], const struct rf_counted_job *job);

#endif
