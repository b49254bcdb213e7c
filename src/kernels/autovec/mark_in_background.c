/* mark_in_background.c: marks windows whose deepest surface is in the background layer too. */
#include "kernels/kernels.h"
#include "kernels/autovec/cell_runs.h"

void RF_VEC(rf_mark_in_background)(uint32_t *restrict range,
                                   const int16_t *const foreground[RF_WINDOW_Y],
                                   int16_t *restrict scratch, int n, int border)
{
    const int16_t *restrict f0 = foreground[0], *restrict f1 = foreground[1];
    const int16_t *restrict f2 = foreground[2];

    for (int x = 0; x < n; x++)
        scratch[border + x] = rf_greater(rf_greater(f0[x], f1[x]), f2[x]);
    rf_repeat_ends(scratch + border, n, border, border + RF_WINDOW_X - 1);
    for (int x = 0; x < n + 2 * border; x++) {
        const int most = (int32_t)range[x] >> 16 & ~1;
        const int in_background = rf_greatest_from(scratch, x) < most - rf_background_depth(most);

        range[x] = (range[x] & ~(uint32_t)RF_IN_BACKGROUND) | (uint32_t)in_background << 16;
    }
}
