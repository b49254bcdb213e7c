/* jpeg_chroma.h: colour that a JPEG stores at half of its size is brought to the size of luma. */
#ifndef RF_FILE_JPEG_CHROMA_H
#define RF_FILE_JPEG_CHROMA_H

#include <stddef.h>
#include <stdint.h>

#include "raster.h"

/* Planes of Y, Cb and Cr, full range, the latter two of (width + 1) / 2 by (height + 1) / 2
 * samples, each the mean of four pixels. Rows are packed; those of Y have twice as many samples,
 * the last of which is beyond an odd width. */
struct rf_jpeg_planes {
    const uint8_t *y, *chroma[2];
    int step; /* by which the lowest frequency of chroma was quantised, 1 at the least */
};

/* Bytes that rf_jpeg_chroma() works in. */
uint64_t rf_jpeg_chroma_bytes(int32_t width, int32_t height);

/*
 * Writes the pixels of a raster, R, G, B. With Y' the means of Y over the squares of a sample, the
 * slope of each chroma along luma is
 *
 *     a = cov(Y', C) / (var(Y') + 64)        over 3 x 3 samples, weights 1 2 1
 *
 * (the guided filter of He et al. 2010, its bound on variance a deviation of 8 codes), and a pixel
 * has
 *
 *     C + a (Y - Y')
 *
 * with C, a and Y' between samples by the weights 9 3 3 1 that decoders interpolate by. So colour
 * changes where luma does, and is interpolated where luma is flat. The mean C' of the four pixels
 * of a sample then misses C by m = C - C', and the pixels are made once more, of samples
 *
 *     C + m m^2 / (m^2 + (2 step)^2)
 *
 * as what exceeds quantisation is colour that interpolation smoothed away. Each sum is exact; both
 * divisions are of single precision.
 *
 * `work` is aligned to 8 bytes.
 */
void rf_jpeg_chroma(struct rf_raster *raster, const struct rf_jpeg_planes *planes, void *work);

#endif
