/* weigh_chroma_vec.c: multiplies chroma by the weights of its pixels, a vector at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* A weight of Q12 in Q15. */
static inline vec_u16 eight_times(vec_u16 weight)
{
    const vec_u16 two = vec_u16_add(weight, weight), four = vec_u16_add(two, two);

    return vec_u16_add(four, four);
}

void RF_VEC(rf_weigh_chroma)(uint16_t *chroma, const uint16_t *weight, int n)
{
    int i = 0;

    for (; i + (int)VEC_U16 <= 2 * n; i += (int)VEC_U16)
        vec_u16_store(chroma + i,
                      vec_s16_scale(vec_u16_load(chroma + i),
                                    eight_times(vec_u16_twice(vec_u16_load(weight + i)))));
    rf_weigh_chroma_c(chroma + i, weight + i, n - i / 2);
}
