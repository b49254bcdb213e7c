/* push1.c: reduces a level of the inpainting pyramid to the next coarser one, one plane of it. */
#include "kernels/push_planes.h"

void RF_VEC(rf_push1)(uint16_t *out, int16_t *out_blur, const uint16_t *upper,
                      const uint16_t *lower, const int16_t *blur0, const int16_t *blur1,
                      int16_t apart, int n)
{
    rf_push_plane(out, out_blur, upper, lower, blur0, blur1, apart, n, true);
}
