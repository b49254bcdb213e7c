/* light.h: contracts of the kernels of means, weights and highlights: light before and after the
 * rays. */
#ifndef RF_KERNELS_LIGHT_H
#define RF_KERNELS_LIGHT_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/slab.h"

/* means: Q14 means of sums of N Q12 values, with scale = rf_mean_scale(N): within
 * 1/2 + N / 2^17 of 4 sum / N, and exact where all N are the same. */
typedef void rf_means_fn(uint16_t *mean, const uint32_t *sum, uint32_t scale, int n);
static inline uint32_t rf_mean_scale(uint64_t rays)
{
    const uint64_t scale = ((UINT64_C(1) << 32) + rays / 2) / rays;

    return scale > UINT32_MAX ? UINT32_MAX : (uint32_t)scale;
}

/* clamp_row: none of n values above `most`. */
typedef void rf_clamp_row_fn(uint16_t *value, uint16_t most, int n);

/* weighted_means: Q14 means of n <= RF_TILE * RF_TILE sums below 2^51 of Q12 values times
 * weights, and of their weights: 4 sum / weight half up, to 2^-35; exact where all values are
 * the same. In double precision, whose four operations are the same everywhere. */
typedef void rf_weighted_means_fn(uint16_t *mean, const uint64_t *sum, const uint64_t *weight,
                                  int n);

/* between_rows: a tile of means from some of its rows, 2, 3 or 5 apart (gather/tile_rows.h), by
 * the cubics through four of them, half up, never beyond the one before and the one after. */
static_assert((uint64_t)13 * (1 << 14) / 8 * UINT16_MAX <= INT32_MAX,
              "shares of magnitudes up to 1.625 in all: sums fit 32 bits");
typedef void rf_between_rows_fn(uint16_t *mean, const uint16_t *computed, int step);

/* between_chroma: eight rows from rows 0 2 5 7 of them, as between_rows. */
typedef void rf_between_chroma_fn(uint16_t *mean, const uint16_t *computed);

/* soften: rows of RF_TILE means, `each` of which are a pixel's, moved by half of share / 65536,
 * rounded down, of how far the average, half up, of its neighbours' is: those to the left and
 * right, but at the ends, and then, if `down` is set, those above and below, but in the first and
 * the last row. */
typedef void rf_soften_fn(uint16_t *mean, int rows, int each, bool down, uint16_t share);

/*
 * composite_thin: over the 16 x 16 means at mean[0] to mean[2], at most 65535, what is drawn
 * in cells of 4 x 4 pixels (thin/coverage.h): 6 x 6 of them, the first one above and to the
 * left of the tile, each of light times cover and cover, Q12 times 2^RF_COVERAGE_SHIFT,
 * between -2 and 2. Between the middles of cells it is linear, rounded down twice, at
 * 2^-8 of Q12 and at Q14.
 *
 *     mean = light + mean - round(cover mean), 0 to 65535;  cover from 0 to 1
 */
enum { RF_COVERAGE_CELLS = 6, RF_COVERAGE_SHIFT = 14 };
static_assert((uint64_t)8 * (2 * 4096) * (1 << RF_COVERAGE_SHIFT) <= INT32_MAX,
              "eighths of cells between -2 and 2 fit 32 bits");
static_assert((uint64_t)UINT16_MAX * (1 << 15) + (1 << 14) <= UINT32_MAX,
              "a mean times cover in Q15, and its rounding");
typedef void rf_composite_thin_fn(uint16_t *const mean[3],
                                  int32_t cell[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4]);

/* brightest: the largest value of any channel of a row. */
typedef uint16_t rf_brightest_fn(const uint16_t *red, const uint16_t *green, const uint16_t *blue,
                                 int n);

#endif
