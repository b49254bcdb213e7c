/* any_in_slab_vec.c: tells whether the blur of any pixel of a block lies in a slab, a vector at a
 * time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

bool RF_VEC(rf_any_in_slab)(const int16_t *blur, ptrdiff_t stride, int width, int height,
                            const struct rf_slab *slab)
{
    const vec_u16 from = vec_u16_set(rf_range_from(slab));
    const vec_u16 to = vec_u16_set(rf_range_to(slab, slab));
    const int last = width - (int)VEC_U16;
    vec_u16 hit = vec_u16_set(0);

    for (int y = 0; y < height; y++, blur += stride)
        for (int x = 0; x < width; x += (int)VEC_U16) {
            const int16_t *const s = blur + (x < last ? x : last);
            const vec_u16 away = vec_u16_sub(vec_u16_load((const uint16_t *)s), from);

            hit = vec_u16_or(hit, vec_s16_less(away, to));
        }
    return vec_u16_any(hit);
}
