/* aim.c: computes where rays see a blur: offsets of rays times blur, in whole pixels. */
#include "kernels/kernels.h"
#include "kernels/autovec/ray_offset.h"

void RF_VEC(rf_aim)(int32_t *restrict offset, int32_t *restrict cell, const int16_t *restrict u,
                    const int16_t *restrict v, int blur, int unit, int32_t stride,
                    int32_t cell_stride, int n)
{
    int16_t x[RF_RAY_CHUNK], y[RF_RAY_CHUNK];
    const int16_t s = (int16_t)blur;

    for (int i = 0; i < n; i++) {
        x[i] = rf_ray_offset(u[i], s, -unit);
        y[i] = rf_ray_offset(v[i], s, -unit);
    }
    for (int i = 0; i < n; i++) {
        offset[i] = x[i] + y[i] * stride;
        cell[i] = (x[i] >> 2) + (y[i] >> 2) * cell_stride;
    }
}
