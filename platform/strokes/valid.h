/* valid.h: whether what a caller hands in is what refocus/platform/strokes.h allows. */
#ifndef RF_STROKES_VALID_H
#define RF_STROKES_VALID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <refocus/platform/strokes.h>

/* NaN is within no bounds. */
bool rf_in_bounds(float value, float least, float greatest);

/* Whether strokes of a kind are drawn by points, and whether they begin a layer. */
bool rf_has_points(uint32_t kind);
bool rf_begins_layer(uint32_t kind);

bool rf_stroke_is_valid(const struct refocus_stroke *stroke);

/* Whether rows of so many bytes can lie so far apart, and the place of each is a ptrdiff_t; rows
 * >= 1. */
bool rf_is_stride(ptrdiff_t stride, ptrdiff_t bytes, int32_t rows);

/* A photo of 8 bits of R, G and B, and a map of its size. */
bool rf_is_photo(const struct refocus_image *photo);
bool rf_is_base(const struct refocus_disparity *base, const struct refocus_image *photo);

#endif
