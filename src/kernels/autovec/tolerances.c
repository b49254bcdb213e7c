/* tolerances.c: computes how far a blur may be off for the ray through it to be off by half a
 * pixel. */
#include "kernels/kernels.h"

#include <math.h>

/* Square root and division are exact to the last bit everywhere. */
void RF_VEC(rf_tolerances)(int32_t *restrict within, const int16_t *restrict u,
                           const int16_t *restrict v, int n)
{
    for (int i = 0; i < n; i++) {
        const int32_t square = u[i] * u[i] + v[i] * v[i];
        const double most = 4194304.0 / sqrt(square); /* 2^22 = half in Q23 */

        within[i] = (int32_t)(most < 32766 ? most : 32766);
    }
}
