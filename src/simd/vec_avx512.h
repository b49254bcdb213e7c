/* vec_avx512.h: AVX2 with the masks and the products of AVX-512 (VL, BW and VNNI), on 256-bit
 * registers: a row of a tile fills one, and no processor slows down for them. */
#ifndef RF_VEC_AVX512_H
#define RF_VEC_AVX512_H

#include <stdbool.h>

#define RF_VEC_OWN_MASKS
#include "simd/vec_avx2.h"

typedef __mmask16 vec_mask;

static inline vec_mask vec_mask_all(void)
{
    return 0xffff;
}

static inline vec_mask vec_mask_less(vec_mask among, vec_u16 a, vec_u16 b)
{
    return _mm256_mask_cmplt_epi16_mask(among, a, b);
}

static inline vec_mask vec_mask_equal(vec_mask among, vec_u16 a, vec_u16 b)
{
    return _mm256_mask_cmpeq_epi16_mask(among, a, b);
}

static inline vec_mask vec_mask_or(vec_mask a, vec_mask b)
{
    return _kor_mask16(a, b);
}

static inline bool vec_mask_any(vec_mask m)
{
    return m != 0;
}

static inline int vec_mask_first(vec_mask m)
{
    return __builtin_ctz(m | 0x8000);
}

static inline vec_u16 vec_u16_choose(vec_mask mask, vec_u16 a, vec_u16 b)
{
    return _mm256_mask_mov_epi16(b, mask, a);
}

static inline vec_mask vec_mask_without(vec_mask a, vec_mask b)
{
    return _kandn_mask16(b, a);
}

static inline vec_u16 vec_u16_add_where(vec_mask mask, vec_u16 sum, vec_u16 v)
{
    return _mm256_mask_add_epi16(sum, mask, sum, v);
}

static inline vec_u16 vec_u16_load_where(vec_mask mask, vec_u16 old, const void *p)
{
    return _mm256_mask_loadu_epi16(old, mask, p);
}

static inline vec_u16 vec_u16_put_where(vec_mask mask, vec_u16 old, vec_u16 v)
{
    return _mm256_mask_mov_epi16(old, mask, v);
}

#endif
