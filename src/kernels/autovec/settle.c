/* settle.c: finds the rays of a search that their first test settles for all pixels of a strip. */
#include "kernels/kernels.h"
#include "kernels/autovec/ray_offset.h"

void RF_VEC(rf_settle)(uint8_t *settled, int32_t *offset, const uint32_t *range,
                       const int32_t *cell, const struct rf_search_rays *rays, int tests,
                       int32_t stride, int32_t cell_stride)
{
    const int32_t own = tests == 1 ? rf_range_least(range[0]) : INT16_MIN - 1;
    const int16_t *restrict u = rays->u, *restrict v = rays->v;
    const int32_t *restrict within = rays->within;
    const int n = rays->rays;
    uint32_t guess[RF_RAY_CHUNK], seen[RF_RAY_CHUNK];
    int32_t there[RF_RAY_CHUNK];
    int16_t x[RF_RAY_CHUNK], y[RF_RAY_CHUNK], same[RF_RAY_CHUNK];

    for (int i = 0; i < n; i++)
        guess[i] = range[cell[i]];
    for (int i = 0; i < n; i++) {
        const int16_t least = rf_range_least(guess[i]), most = rf_range_most(guess[i]);
        const int16_t far_x = rf_ray_offset(u[i], most, 0), far_y = rf_ray_offset(v[i], most, 0);

        x[i] = rf_ray_offset(u[i], least, 0);
        y[i] = rf_ray_offset(v[i], least, 0);
        same[i] = (x[i] == far_x) & (y[i] == far_y);
    }
    for (int i = 0; i < n; i++) {
        offset[i] = x[i] + y[i] * stride;
        there[i] = (x[i] >> 2) + (y[i] >> 2) * cell_stride;
    }
    for (int i = 0; i < n; i++)
        seen[i] = range[there[i]];
    for (int i = 0; i < n; i++) {
        const int32_t least = rf_range_least(guess[i]), most = rf_range_most(guess[i]);
        const int32_t low = rf_range_least(seen[i]), high = rf_range_most(seen[i]);

        settled[i] =
            (uint8_t)(same[i] &
                      (((high - least <= within[i]) & (most - low <= within[i])) | (high <= own)));
    }
}
