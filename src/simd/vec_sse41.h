/* vec_sse41.h: the vector operations of vec.h on 128-bit registers of x86. */
#ifndef RF_VEC_SSE41_H
#define RF_VEC_SSE41_H

#include <smmintrin.h>
#include <stdint.h>

enum { VEC_U16 = 8, VEC_U8 = 16, VEC_BITS = 2 };
typedef __m128i vec_u16, vec_u8;

typedef struct {
    __m128i low, high;
} vec_u32;

#define VEC_LANES(name) _mm_##name
#define VEC_WHOLE(name) _mm_##name##_si128
#include "simd/vec_x86.h"

static inline vec_u16 vec_u16_from_bytes(const uint8_t *p)
{
    return _mm_cvtepu8_epi16(_mm_loadl_epi64((const __m128i *)p));
}

static inline uint16_t vec_u16_lane0(vec_u16 a)
{
    return (uint16_t)_mm_cvtsi128_si32(a);
}

static inline vec_u16 vec_u16_spread(vec_u16 a)
{
    return _mm_shuffle_epi8(a, _mm_set1_epi16(0x0100));
}

static inline vec_u16 vec_u16_even(vec_u16 a, vec_u16 b)
{
    const __m128i low = _mm_set1_epi32(0xffff);

    return _mm_packus_epi32(_mm_and_si128(a, low), _mm_and_si128(b, low));
}

static inline vec_u16 vec_u16_odd(vec_u16 a, vec_u16 b)
{
    return _mm_packus_epi32(_mm_srli_epi32(a, 16), _mm_srli_epi32(b, 16));
}

static inline vec_u16 vec_u16_zip_low(vec_u16 a, vec_u16 b)
{
    return _mm_unpacklo_epi16(a, b);
}

static inline vec_u16 vec_u16_zip_high(vec_u16 a, vec_u16 b)
{
    return _mm_unpackhi_epi16(a, b);
}

static inline void vec_u16_add_to(uint32_t *sum, vec_u16 v)
{
    const __m128i zero = _mm_setzero_si128();
    __m128i *low = (__m128i *)sum, *high = (__m128i *)(sum + 4);

    _mm_storeu_si128(low, _mm_add_epi32(_mm_loadu_si128(low), _mm_unpacklo_epi16(v, zero)));
    _mm_storeu_si128(high, _mm_add_epi32(_mm_loadu_si128(high), _mm_unpackhi_epi16(v, zero)));
}

static inline int32_t vec_dot16(const int16_t *p, const int16_t *q)
{
    __m128i s = _mm_add_epi32(_mm_madd_epi16(vec_u16_load(p), vec_u16_load(q)),
                              _mm_madd_epi16(vec_u16_load(p + 8), vec_u16_load(q + 8)));

    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    return _mm_cvtsi128_si32(_mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1)));
}

static inline uint32_t vec_within16(const uint16_t *p, uint16_t low, uint16_t width)
{
    const __m128i a = _mm_sub_epi16(vec_u16_load(p), vec_u16_set(low));
    const __m128i b = _mm_sub_epi16(vec_u16_load(p + 8), vec_u16_set(low));
    const __m128i within = _mm_packs_epi16(
        _mm_cmpeq_epi16(_mm_subs_epu16(a, vec_u16_set(width)), _mm_setzero_si128()),
        _mm_cmpeq_epi16(_mm_subs_epu16(b, vec_u16_set(width)), _mm_setzero_si128()));

    return (uint32_t)_mm_movemask_epi8(within);
}

static inline uint64_t vec_within64(const uint16_t *p, uint16_t low, uint16_t width)
{
    uint64_t bits = 0;

    for (int i = 0; i < 64; i += 16)
        bits |= (uint64_t)vec_within16(p + i, low, width) << i;
    return bits;
}

static inline vec_u8 vec_u8_table(const uint8_t *p)
{
    return _mm_loadu_si128((const __m128i *)p);
}

static inline void vec_u8_store_wide(uint16_t *p, const vec_u16 sum[2])
{
    const __m128i even = _mm_sub_epi16(sum[0], _mm_slli_epi16(sum[1], 8));

    vec_u16_store(p, _mm_unpacklo_epi16(even, sum[1]));
    vec_u16_store(p + 8, _mm_unpackhi_epi16(even, sum[1]));
}

static inline vec_u8 vec_u8_of_masks(vec_u16 a, vec_u16 b)
{
    return _mm_packs_epi16(a, b);
}

static inline uint8_t vec_u8_least(vec_u8 v)
{
    return (uint8_t)_mm_cvtsi128_si32(_mm_minpos_epu16(_mm_min_epu8(v, _mm_srli_epi16(v, 8))));
}

static inline uint8_t vec_u8_most(vec_u8 v)
{
    return (uint8_t)~vec_u8_least(_mm_xor_si128(v, _mm_set1_epi8(-1)));
}

static inline vec_u32 vec_u32_add_products(vec_u32 sum, vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d)
{
    sum.low =
        _mm_add_epi32(sum.low, _mm_madd_epi16(_mm_unpacklo_epi16(a, c), _mm_unpacklo_epi16(b, d)));
    sum.high =
        _mm_add_epi32(sum.high, _mm_madd_epi16(_mm_unpackhi_epi16(a, c), _mm_unpackhi_epi16(b, d)));
    return sum;
}

static inline void vec_u64_add_four(uint64_t *to, __m128i v)
{
    const __m128i zero = _mm_setzero_si128();
    __m128i *low = (__m128i *)to, *high = (__m128i *)(to + 2);

    _mm_storeu_si128(low, _mm_add_epi64(_mm_loadu_si128(low), _mm_unpacklo_epi32(v, zero)));
    _mm_storeu_si128(high, _mm_add_epi64(_mm_loadu_si128(high), _mm_unpackhi_epi32(v, zero)));
}

static inline void vec_u32_add_to(uint64_t *to, vec_u32 v)
{
    vec_u64_add_four(to, v.low);
    vec_u64_add_four(to + 4, v.high);
}

#include "simd/vec_mask.h"

#endif
