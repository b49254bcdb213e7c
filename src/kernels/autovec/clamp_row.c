/* clamp_row.c: clamps the values of a row. */
#include "kernels/kernels.h"

void RF_VEC(rf_clamp_row)(uint16_t *restrict value, uint16_t most, int n)
{
    for (int i = 0; i < n; i++)
        value[i] = value[i] < most ? value[i] : most;
}
