/* weigh_chroma.c: multiplies chroma by the weights of its pixels. */
#include "kernels/kernels.h"

void rf_weigh_chroma_c(uint16_t *chroma, const uint16_t *weight, int n)
{
    for (int i = 0; i < 2 * n; i++)
        chroma[i] = (uint16_t)((chroma[i] * weight[i & ~1] + 2048) / 4096);
}
