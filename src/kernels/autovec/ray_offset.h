/* ray_offset.h: the offset in samples at which a ray sees a blur, by 16-bit products. */
#ifndef RF_KERNELS_RAY_OFFSET_H
#define RF_KERNELS_RAY_OFFSET_H

#include <stdint.h>

/* floor((u s + 2^(22 + shift)) / 2^(23 + shift)), by the high half of the product; shift: -6 to 1.
 */
static inline int16_t rf_ray_offset(int16_t u, int16_t blur, int shift)
{
    return (int16_t)((int16_t)((int16_t)(u * blur >> 16) + (1 << (6 + shift))) >> (7 + shift));
}

#endif
