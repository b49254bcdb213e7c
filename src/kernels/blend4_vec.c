/* blend4_vec.c: the depth upsampler: computes the weighted mean of four rows of samples, a vector
 * at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

void RF_VEC(rf_blend4)(uint16_t *out, const uint16_t *const row[RF_TAPS],
                       const int16_t share[RF_TAPS], int n)
{
    const uint16_t *a = row[0], *b = row[1], *c = row[2], *d = row[3];
    int x = 0;

    for (; x + (int)VEC_U16 <= n; x += VEC_U16)
        vec_u16_store(out + x, vec_u16_mix4(vec_u16_load(a + x), vec_u16_load(b + x),
                                            vec_u16_load(c + x), vec_u16_load(d + x), share));
    rf_blend4_c(out + x, (const uint16_t *const[RF_TAPS]){a + x, b + x, c + x, d + x}, share,
                n - x);
}
