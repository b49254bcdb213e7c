/* pull_blur_vec.c: gives the unknown pixels of a pyramid level the blur of their parents, a vector
 * of parents at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"
#include "kernels/pyramid_vec.h"

void RF_VEC(rf_pull_blur)(int16_t *out, const int16_t *near_row, int pairs)
{
    int x = 0;

    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16) {
        const vec_u16 left = rf_unknown(vec_u16_load(out + 2 * x));
        const vec_u16 right = rf_unknown(vec_u16_load(out + 2 * x + (int)VEC_U16));
        const vec_u16 near = vec_u16_load(near_row + x);

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        rf_put_where(out + 2 * x, left, vec_u16_zip_low(near, near));
        rf_put_where(out + 2 * x + (int)VEC_U16, right, vec_u16_zip_high(near, near));
    }
    rf_pull_blur_c(out + 2 * x, near_row + x, pairs - x);
}
