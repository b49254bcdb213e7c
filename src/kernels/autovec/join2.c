/* join2.c: interleaves two rows to a row of pairs: the two values of samples of chroma. */
#include "kernels/kernels.h"

void RF_VEC(rf_join2)(uint16_t *restrict out, const uint16_t *restrict first,
                      const uint16_t *restrict second, int n)
{
    for (int x = 0; x < n; x++) {
        out[2 * x] = first[x];
        out[2 * x + 1] = second[x];
    }
}
