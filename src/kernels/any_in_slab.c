/* any_in_slab.c: tells whether the blur of any pixel of a block lies in a slab. */
#include "kernels/kernels.h"

bool rf_any_in_slab_c(const int16_t *blur, ptrdiff_t stride, int width, int height,
                      const struct rf_slab *slab)
{
    const uint16_t from = rf_range_from(slab), to = rf_range_to(slab, slab);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (rf_in_range(from, to, blur[y * stride + x]))
                return true;
    return false;
}
