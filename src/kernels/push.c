/* push.c: reduces a level of the inpainting pyramid to the next coarser one, three planes of it. */
#include "kernels/push_planes.h"

void rf_push_c(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
               const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1,
               int16_t apart, int n)
{
    rf_push_plane(out[0], out_blur, upper[0], lower[0], blur0, blur1, apart, n, true);
    for (int c = 1; c < 3; c++)
        rf_push_plane(out[c], NULL, upper[c], lower[c], blur0, blur1, apart, n, false);
}
