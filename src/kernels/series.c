/* series.c: a row of the Chebyshev series of heat flow, for the compiler's vectoriser.
 *
 * Compiled once as plain C and once for each instruction set. Single precision, in the order
 * that is written: every set gives the same bits. */
#include "kernels/kernels.h"
#include "simd/vec.h"

static void RF_VEC(rf_series_row)(float *restrict row, const struct rf_series_job *job, int n)
{
    const float *restrict here = job->here, *restrict start = job->start;
    const float *restrict across = job->across, *restrict own = job->own;
    const ptrdiff_t stride = job->stride;
    const float share = job->share;

    for (int x = 0; x < n; x++) {
        const float around = (here[x - stride] + here[x + stride]) + (here[x - 1] + here[x + 1]);

        row[x] = share * start[x] + ((across[x] * around + own[x] * here[x]) - row[x]);
    }
}

void RF_VEC(rf_series_use)(struct rf_kernels *kernels)
{
    kernels->series_row = RF_VEC(rf_series_row);
}
