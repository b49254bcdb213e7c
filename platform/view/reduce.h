/* reduce.h: a photo and its depth, smaller by a whole number. */
#ifndef RF_VIEW_REDUCE_H
#define RF_VIEW_REDUCE_H

#include <stdint.h>
#include <refocus/image.h>

/* Means of squares of n x n pixels, in linear light; those at the right and lower
 * border are smaller. to: RGB8, packed, ceil(width / n) x ceil(height / n). */
void rf_reduce_photo(const struct refocus_image *photo, int n, uint8_t *to);

/* The disparity in the middle of each square of a part of the reduced map: no two are
 * mixed. */
void rf_reduce_disparity(const uint16_t *disparity, int width, int height, int n, uint16_t *to);

#endif
