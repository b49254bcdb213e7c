/* greatest.c: the greatest of some rows at each place. */
#include "kernels/kernels.h"

void RF_VEC(rf_greatest)(uint16_t *out, const uint16_t *const *row, int rows, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t most = row[0][x];

        for (int k = 1; k < rows; k++)
            most = row[k][x] > most ? row[k][x] : most;
        out[x] = most;
    }
}
