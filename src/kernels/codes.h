/* codes.h: contracts of the kernels that smooth a disparity map of few codes. */
#ifndef RF_KERNELS_CODES_H
#define RF_KERNELS_CODES_H

#include <assert.h>
#include <stdint.h>

/*
 * Codes of a disparity map that has few of them; src/depth/dequantise.h says why.
 *
 * smooth_codes: a 3x3 binomial mean of row[1], with neighbours `apart` pixels to either side and in
 * row[0] and row[2], of which pixels -apart to n - 1 + apart are read:
 *
 *     out = own + (sum of w (neighbour - own) + 8 >> 4)
 *
 * w is 2 beside, above and below, and 1 in the corners; but 0 for two opposite neighbours of which
 * one's code is more than `most` away: so a plane stays one up to its edge. most <=
 * RF_MOST_SMOOTHED, so sums stay below 2^15.
 * clamp_codes: each code becomes the smooth value, clamped to `most` from its own.
 */
enum { RF_MOST_SMOOTHED = (32767 - 8) / 12 };
static_assert(12 * RF_MOST_SMOOTHED + 8 <= INT16_MAX, "the weighted sum of eight fits 16 bits");
typedef void rf_smooth_codes_fn(uint16_t *out, const uint16_t *const row[3], int apart,
                                uint16_t most, int n);
typedef void rf_clamp_codes_fn(uint16_t *code, const uint16_t *smooth, uint16_t most, int n);

#endif
