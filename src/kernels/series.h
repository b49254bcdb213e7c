/* series.h: the contract of series_row, a step of diffusion. */
#ifndef RF_KERNELS_SERIES_H
#define RF_KERNELS_SERIES_H

#include <stddef.h>

/*
 * series_row: a row of a step of Clenshaw's recursion, on a field V of which a pixel passes
 * some on to its four neighbours,
 *
 *     row = share start + (across (up + down + (left + right)) + own here) - row
 *
 * in single precision; elements -1 and n of `here` are read, and the rows `stride` before and
 * after it. Nothing overlaps.
 */
struct rf_series_job {
    const float *here, *start, *across, *own;
    ptrdiff_t stride; /* elements */
    float share;
};
typedef void rf_series_row_fn(float *row, const struct rf_series_job *job, int n);

#endif
