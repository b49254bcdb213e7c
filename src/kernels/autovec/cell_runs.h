/* cell_runs.h: steps that kernels of cells and windows of blurs share. */
#ifndef RF_KERNELS_CELL_RUNS_H
#define RF_KERNELS_CELL_RUNS_H

#include "kernels/kernels.h"

enum { RF_CELL_RUN = 64 }; /* cells at a time */

static inline void rf_repeat_ends(int16_t *row, int n, int left, int right)
{
    for (int x = 1; x <= left; x++)
        row[-x] = row[0];
    for (int x = 0; x < right; x++)
        row[n + x] = row[n - 1];
}

static inline int16_t rf_greatest_from(const int16_t *high, int x)
{
    return rf_greater(
        rf_greater(rf_greater(high[x], high[x + 1]), rf_greater(high[x + 2], high[x + 3])),
        high[x + 4]);
}

#endif
