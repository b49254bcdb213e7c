/* pull.c: inpaints the unknown pixels of a pyramid level from the coarser one. */
#include "kernels/kernels.h"

static uint16_t quarters(unsigned three, unsigned one)
{
    return (uint16_t)((3 * three + one + 2) >> 2);
}

void rf_pull_c(uint16_t *out, const int16_t *out_blur, const uint16_t *near_row,
               const uint16_t *far_row, uint16_t *mixed, int pairs)
{
    mixed++; /* mixed[-1] and mixed[pairs] repeat the ends */
    for (int x = 0; x < pairs; x++)
        mixed[x] = quarters(near_row[x], far_row[x]);
    mixed[-1] = mixed[0];
    mixed[pairs] = mixed[pairs - 1];
    for (int i = 0; i < 2 * pairs; i++)
        if (out_blur[i] == RF_NO_BLUR)
            out[i] = quarters(mixed[i / 2], mixed[i / 2 + (i % 2 ? 1 : -1)]);
}
