/* pyramid_vec.h: finds and overwrites the unknown pixels of the inpainting pyramid, in vectors. */
#ifndef RF_KERNELS_PYRAMID_VEC_H
#define RF_KERNELS_PYRAMID_VEC_H

#include "kernels/kernels.h"
#include "simd/vec.h"

/* Lanes where nothing is known, all bits. */
static inline vec_u16 rf_unknown(vec_u16 blur)
{
    return vec_u16_at_most(vec_u16_xor(blur, vec_u16_set(0x8000)), vec_u16_set(0));
}

/* Where lanes of `mask` are set, `to` becomes v. */
static inline void rf_put_where(void *to, vec_u16 mask, vec_u16 v)
{
    vec_u16_store(to, vec_u16_or(vec_u16_and(v, mask), vec_u16_without(vec_u16_load(to), mask)));
}

#endif
