/* pull_blur.c: gives the unknown pixels of a pyramid level the blur of their parents. */
#include "kernels/kernels.h"

void rf_pull_blur_c(int16_t *out, const int16_t *near_row, int pairs)
{
    for (int i = 0; i < 2 * pairs; i++)
        if (out[i] == RF_NO_BLUR)
            out[i] = near_row[i / 2];
}
