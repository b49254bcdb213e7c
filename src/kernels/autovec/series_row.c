/* series_row.c: computes a row of one step of the Chebyshev series of heat flow. */
#include "kernels/kernels.h"

void RF_VEC(rf_series_row)(float *restrict row, const struct rf_series_job *job, int n)
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
