/* speckle.h: marks small patches of wrong depth as unknown. */
#ifndef RF_SPECKLE_H
#define RF_SPECKLE_H

#include <stddef.h>
#include <stdint.h>

/*
 * Marks known samples as unknown that belong to a patch of fewer than `least` samples: samples
 * that touch, across corners too, and do not differ by more than 1/24 of the range.
 *
 * state: width x height, RF_SAMPLE_KNOWN or RF_SAMPLE_UNKNOWN
 * work:  width x height
 * Returns how many samples were marked. Linear in the number of samples.
 */
uint64_t rf_remove_specks(const uint16_t *disparity, ptrdiff_t stride, int width, int height,
                          int least, uint8_t *state, uint32_t *work);

#endif
