/* signed_blur.c: computes the signed blur radius of each pixel of a row from its disparity. */
#include "kernels/kernels.h"

void RF_VEC(rf_signed_blur)(int16_t *restrict blur, const uint16_t *restrict disparity,
                            struct rf_focus focus, int n)
{
    const uint16_t df = focus.disparity, radius = focus.radius;

    for (int x = 0; x < n; x++) {
        const uint16_t d = disparity[x];
        const uint16_t near = (uint16_t)(d > df ? 0xffff : 0);
        const uint16_t distance = (uint16_t)((uint16_t)((uint16_t)(df - d) ^ near) - near);
        const uint16_t high = (uint16_t)(((uint32_t)distance * radius) >> 16);
        const uint16_t low = (uint16_t)(distance * (uint32_t)radius);
        const uint16_t r = (uint16_t)(high + (low >> 15)); /* half up, in 16-bit lanes */

        blur[x] = (int16_t)((uint16_t)(r ^ near) - near);
    }
}
