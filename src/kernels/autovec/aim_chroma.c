/* aim_chroma.c: computes where rays see a blur among samples of chroma. */
#include "kernels/kernels.h"
#include "kernels/autovec/ray_offset.h"

void RF_VEC(rf_aim_chroma)(int32_t *restrict offset, int32_t *restrict pixel,
                           const int16_t *restrict u, const int16_t *restrict v, int blur, int unit,
                           int down, int32_t stride, int n)
{
    const int16_t s = (int16_t)blur;

    for (int i = 0; i < n; i++) {
        const int32_t x = 2 * rf_ray_offset(u[i], s, 1 - unit);
        const int32_t y = rf_ray_offset(v[i], s, down - unit) * stride;

        offset[i] = x + y;
        pixel[i] = x + y * (1 << down);
    }
}
