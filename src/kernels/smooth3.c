/* smooth3.c: computes a step of the pre-filter on three planes. */
#include "kernels/kernels.h"

void rf_smooth3_c(uint16_t *const out[3], const uint16_t *const light[3], const int16_t *blur,
                  ptrdiff_t apart, int least, int over, int n)
{
    for (int c = 0; c < 3; c++)
        rf_smooth1_c(out[c], light[c], blur, apart, least, over, n);
}
