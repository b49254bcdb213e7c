/* upsample.h: a disparity map of any size brought to the photo's. */
#ifndef RF_UPSAMPLE_H
#define RF_UPSAMPLE_H

#include <refocus/image.h>

#include "kernels/kernels.h"
#include "support/pool.h"

/* Where a pixel lies among the samples of its row or column. */
struct rf_taps {
    int32_t first;           /* of four samples, -2 to samples - 2 */
    uint16_t share[RF_TAPS]; /* Q16, of sum 1 */
};

/*
 * Each pixel looks at the 4 x 4 samples around it, weighted by nearness and by how much the
 * photo at the sample's place looks like the photo here. Where no two neighbours among them
 * are farther apart than 1/24 of the range, it takes the mean by nearness. Elsewhere samples
 * within 1/12 of the range are one surface: the surface with the most weight wins, and only
 * its samples are averaged, so that no disparity between two surfaces is invented; a median of
 * 3 x 3 follows. A map that has more columns or rows than the photo is sampled first.
 *
 * All the memory is the caller's. Elements -2 to samples + 1 of rows -2 to samples + 1 of
 * `coarse` and -1 to width of `raw` are used.
 */
struct rf_upsampler {
    const struct rf_kernels *kernels;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    const uint8_t *confidence; /* of each sample of the map, or NULL */
    ptrdiff_t confidence_stride;
    int columns, rows;         /* samples that are used: rf_upsample_samples() */

    uint16_t *coarse; /* samples */
    ptrdiff_t coarse_stride;
    uint16_t *wide; /* rows x width: each row of samples as long as the photo's */
    ptrdiff_t wide_stride;
    uint16_t *raw; /* height x width: before the median */
    ptrdiff_t raw_stride;
    struct rf_taps *across, *down; /* width and height of them */
    uint16_t *near_by[RF_TAPS]; /* of columns, width + RF_BATCH_SPARE each: how near they are */
    int32_t *column; /* -2 to columns + 1: where in a row of the photo a sample is, in bytes */
    uint16_t *(*scratch)(void *context, int worker); /* 2 (columns + 8) elements */
    void *context;
    struct rf_run *run;

    uint16_t *out;
    ptrdiff_t out_stride; /* elements */
};

static inline int rf_upsample_samples(int samples, int size)
{
    return samples < size ? samples : size;
}

void rf_upsample(struct rf_upsampler *up, struct rf_pool *pool);

#endif
