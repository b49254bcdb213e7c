/* edge_support.c: how much of an edge the photo has around one of the map. */
#include "kernels/kernels.h"

static RF_ALWAYS_INLINE void add_row(int32_t *restrict sum, const int16_t *restrict gx,
                                     const int16_t *restrict gy, int32_t right, int32_t down, int n)
{
#pragma GCC unroll 1 /* whole vectors, not elements */
    for (int x = 0; x < n; x++) {
        const int32_t across = gx[x] * right + gy[x] * down;
        const int32_t support = (across < 0 ? -across : across) >> 7;

        sum[x] += support < RF_MOST_PHOTO_EDGE ? support : RF_MOST_PHOTO_EDGE;
    }
}

void RF_VEC(rf_edge_support)(int32_t *sum, const struct rf_edge_window *w)
{
    for (int y = 0; y < w->rows; y++) {
        const int16_t *gx = w->gradient_x + y * w->stride, *gy = w->gradient_y + y * w->stride;

        if (w->columns == 12)
            add_row(sum + 12 * y, gx, gy, w->normal_x, w->normal_y, 12);
        else
            add_row(sum + 8 * y, gx, gy, w->normal_x, w->normal_y, 8);
    }
}
