/* windows.c: finds the least and the greatest blur of windows of cells from those of the cells. */
#include "kernels/kernels.h"
#include "kernels/autovec/cell_runs.h"

/* The least, and the greatest, of RF_WINDOW_X beside each other from x on. */
static inline int16_t least_from(const int16_t *low, int x)
{
    return rf_lesser(rf_lesser(rf_lesser(low[x], low[x + 1]), rf_lesser(low[x + 2], low[x + 3])),
                     low[x + 4]);
}

void RF_VEC(rf_windows)(uint32_t *restrict range, const int16_t *const least[RF_WINDOW_Y],
                        const int16_t *const most[RF_WINDOW_Y], int16_t *restrict scratch, int n,
                        int border)
{
    const int windows = n + 2 * border, beyond = border + RF_WINDOW_X - 1;
    int16_t *restrict low = scratch, *restrict high = scratch + n + border + beyond;
    const int16_t *restrict l0 = least[0], *restrict l1 = least[1], *restrict l2 = least[2];
    const int16_t *restrict m0 = most[0], *restrict m1 = most[1], *restrict m2 = most[2];

    for (int x = 0; x < n; x++) {
        low[border + x] = rf_lesser(rf_lesser(l0[x], l1[x]), l2[x]);
        high[border + x] = rf_greater(rf_greater(m0[x], m1[x]), m2[x]);
    }
    rf_repeat_ends(low + border, n, border, beyond);
    rf_repeat_ends(high + border, n, border, beyond);
    for (int x = 0; x < windows; x++) {
        const int16_t l = least_from(low, x);
        const int16_t h = (int16_t)((rf_greatest_from(high, x) + 1) & ~1);

        range[x] = (uint16_t)l | (uint32_t)(uint16_t)h << 16;
    }
}
