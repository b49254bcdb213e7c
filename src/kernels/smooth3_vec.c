/* smooth3_vec.c: computes a step of the pre-filter on three planes, a vector at a time. */
#include "kernels/smooth_planes_vec.h"

void RF_VEC(rf_smooth3)(uint16_t *const out[3], const uint16_t *const light[3], const int16_t *blur,
                        ptrdiff_t apart, int least, int over, int n)
{
    if (n < (int)VEC_U16)
        rf_smooth3_c(out, light, blur, apart, least, over, n);
    else
        rf_smooth_planes_vec(out, light, blur, apart, least, over, n, 3);
}
