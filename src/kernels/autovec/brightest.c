/* brightest.c: finds the largest value of three rows of light. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

uint16_t RF_VEC(rf_brightest)(const uint16_t *restrict red, const uint16_t *restrict green,
                              const uint16_t *restrict blue, int n)
{
    uint16_t most = 0;

    for (int x = 0; x < n; x++)
        most = rf_most16(most, rf_most16(red[x], rf_most16(green[x], blue[x])));
    return most;
}
