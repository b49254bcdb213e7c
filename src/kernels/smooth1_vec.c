/* smooth1_vec.c: computes a step of the pre-filter on one plane, a vector of pixels at a time. */
#include "kernels/smooth_planes_vec.h"

void RF_VEC(rf_smooth1)(uint16_t *out, const uint16_t *light, const int16_t *blur, ptrdiff_t apart,
                        int least, int over, int n)
{
    if (n < (int)VEC_U16)
        rf_smooth1_c(out, light, blur, apart, least, over, n);
    else
        rf_smooth_planes_vec(&out, &light, blur, apart, least, over, n, 1);
}
