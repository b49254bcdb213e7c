/* split2.c: splits rows of pairs, samples of chroma, into a row of each value, and averages two
 * rows. */
#include "kernels/kernels.h"

void RF_VEC(rf_split2)(uint16_t *restrict first, uint16_t *restrict second, const uint16_t *upper,
                       const uint16_t *lower, int n)
{
    for (int x = 0; x < n; x++) {
        first[x] = (uint16_t)((upper[2 * x] + lower[2 * x] + 1) >> 1);
        second[x] = (uint16_t)((upper[2 * x + 1] + lower[2 * x + 1] + 1) >> 1);
    }
}
