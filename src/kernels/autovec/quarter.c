/* quarter.c: the depth upsampler: reduces the colours of pixels to steps of four codes, a plane
 * each. */
#include "kernels/kernels.h"

void RF_VEC(rf_quarter)(uint8_t *const out[3], const uint8_t *restrict pixels, int bytes, int n)
{
    uint8_t *restrict first = out[0], *restrict second = out[1];
    uint8_t *restrict third = out[2];

    if (bytes == 3)
        for (int x = 0; x < n; x++) {
            first[x] = pixels[3 * x] >> 2;
            second[x] = pixels[3 * x + 1] >> 2;
            third[x] = pixels[3 * x + 2] >> 2;
        }
    else
        for (int x = 0; x < n; x++) {
            first[x] = pixels[4 * x] >> 2;
            second[x] = pixels[4 * x + 1] >> 2;
            third[x] = pixels[4 * x + 2] >> 2;
        }
}
