/* vec_avx2.h: the vector operations of vec.h on 256-bit registers. */
#ifndef RF_VEC_AVX2_H
#define RF_VEC_AVX2_H

#include <immintrin.h>
#include <stdint.h>

enum { VEC_U16 = 16 };
typedef __m256i vec_u16;

static inline vec_u16 vec_u16_load(const void *p)
{
    return _mm256_loadu_si256((const __m256i *)p);
}

static inline void vec_u16_store(void *p, vec_u16 v)
{
    _mm256_storeu_si256((__m256i *)p, v);
}

static inline vec_u16 vec_u16_set(uint16_t x)
{
    return _mm256_set1_epi16((int16_t)x);
}

static inline vec_u16 vec_u16_add(vec_u16 a, vec_u16 b)
{
    return _mm256_add_epi16(a, b);
}

static inline vec_u16 vec_u16_sub(vec_u16 a, vec_u16 b)
{
    return _mm256_sub_epi16(a, b);
}

static inline vec_u16 vec_u16_and(vec_u16 a, vec_u16 b)
{
    return _mm256_and_si256(a, b);
}

static inline vec_u16 vec_u16_without(vec_u16 a, vec_u16 b)
{
    return _mm256_andnot_si256(b, a);
}

static inline vec_u16 vec_u16_at_most(vec_u16 a, vec_u16 b)
{
    return _mm256_cmpeq_epi16(_mm256_min_epu16(a, b), a);
}

static inline void vec_u16_add_to(uint32_t *sum, vec_u16 v)
{
    __m256i *low = (__m256i *)sum, *high = (__m256i *)(sum + 8);

    _mm256_storeu_si256(low, _mm256_add_epi32(_mm256_loadu_si256(low),
                                              _mm256_cvtepu16_epi32(_mm256_castsi256_si128(v))));
    _mm256_storeu_si256(high,
                        _mm256_add_epi32(_mm256_loadu_si256(high),
                                         _mm256_cvtepu16_epi32(_mm256_extracti128_si256(v, 1))));
}

static inline vec_u16 vec_s16_less(vec_u16 a, vec_u16 b)
{
    return _mm256_cmpgt_epi16(b, a);
}

static inline vec_u16 vec_u16_select(vec_u16 m, vec_u16 a, vec_u16 b)
{
    return _mm256_blendv_epi8(b, a, m);
}

#endif
