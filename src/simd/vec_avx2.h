/* vec_avx2.h: the vector operations of vec.h on 256-bit registers. */
#ifndef RF_VEC_AVX2_H
#define RF_VEC_AVX2_H

#include <immintrin.h>
#include <stdint.h>

enum { VEC_U16 = 16, VEC_U8 = 32, VEC_BITS = 2 };
typedef __m256i vec_u16, vec_u8;

/* Lanes 0-3 and 8-11, and 4-7 and 12-15: as unpacking leaves them. */
typedef struct {
    __m256i low, high;
} vec_u32;

#define VEC_LANES(name) _mm256_##name
#define VEC_WHOLE(name) _mm256_##name##_si256
#include "simd/vec_x86.h"

static inline vec_u16 vec_u16_from_bytes(const uint8_t *p)
{
    return _mm256_cvtepu8_epi16(_mm_loadu_si128((const __m128i *)p));
}

static inline uint16_t vec_u16_lane0(vec_u16 a)
{
    return (uint16_t)_mm_cvtsi128_si32(_mm256_castsi256_si128(a));
}

static inline vec_u16 vec_u16_spread(vec_u16 a)
{
    return _mm256_broadcastw_epi16(_mm256_castsi256_si128(a));
}

/* packus and unpack work on 128-bit halves. */
static inline vec_u16 vec_u16_even(vec_u16 a, vec_u16 b)
{
    const __m256i low = _mm256_set1_epi32(0xffff);

    return _mm256_permute4x64_epi64(
        _mm256_packus_epi32(_mm256_and_si256(a, low), _mm256_and_si256(b, low)), 0xd8);
}

static inline vec_u16 vec_u16_odd(vec_u16 a, vec_u16 b)
{
    return _mm256_permute4x64_epi64(
        _mm256_packus_epi32(_mm256_srli_epi32(a, 16), _mm256_srli_epi32(b, 16)), 0xd8);
}

static inline vec_u16 vec_u16_zip_low(vec_u16 a, vec_u16 b)
{
    return _mm256_permute2x128_si256(_mm256_unpacklo_epi16(a, b), _mm256_unpackhi_epi16(a, b),
                                     0x20);
}

static inline vec_u16 vec_u16_zip_high(vec_u16 a, vec_u16 b)
{
    return _mm256_permute2x128_si256(_mm256_unpacklo_epi16(a, b), _mm256_unpackhi_epi16(a, b),
                                     0x31);
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

static inline int32_t vec_dot16(const int16_t *p, const int16_t *q)
{
    const __m256i sum = _mm256_madd_epi16(vec_u16_load(p), vec_u16_load(q));
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));

    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    return _mm_cvtsi128_si32(_mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1)));
}

static inline uint32_t vec_within16(const uint16_t *p, uint16_t low, uint16_t width)
{
    const __m256i above = _mm256_sub_epi16(vec_u16_load(p), vec_u16_set(low));
    const __m256i within =
        _mm256_cmpeq_epi16(_mm256_subs_epu16(above, vec_u16_set(width)), _mm256_setzero_si256());

    return (uint32_t)_mm_movemask_epi8(
        _mm_packs_epi16(_mm256_castsi256_si128(within), _mm256_extracti128_si256(within, 1)));
}

static inline uint32_t vec_within32(const uint16_t *p, __m256i low, __m256i width)
{
    const __m256i zero = _mm256_setzero_si256();
    const __m256i a = _mm256_subs_epu16(_mm256_sub_epi16(vec_u16_load(p), low), width);
    const __m256i b = _mm256_subs_epu16(_mm256_sub_epi16(vec_u16_load(p + 16), low), width);
    const __m256i within =
        _mm256_packs_epi16(_mm256_cmpeq_epi16(a, zero), _mm256_cmpeq_epi16(b, zero));

    return (uint32_t)_mm256_movemask_epi8(_mm256_permute4x64_epi64(within, 0xd8));
}

static inline uint64_t vec_within64(const uint16_t *p, uint16_t low, uint16_t width)
{
    const __m256i l = vec_u16_set(low), w = vec_u16_set(width);

    return vec_within32(p, l, w) | (uint64_t)vec_within32(p + 32, l, w) << 32;
}

static inline vec_u8 vec_u8_table(const uint8_t *p)
{
    return _mm256_broadcastsi128_si256(_mm_loadu_si128((const __m128i *)p));
}

static inline void vec_u8_store_wide(uint16_t *p, const vec_u16 sum[2])
{
    const __m256i even = _mm256_sub_epi16(sum[0], _mm256_slli_epi16(sum[1], 8));
    const __m256i low = _mm256_unpacklo_epi16(even, sum[1]);
    const __m256i high = _mm256_unpackhi_epi16(even, sum[1]);

    vec_u16_store(p, _mm256_permute2x128_si256(low, high, 0x20));
    vec_u16_store(p + 16, _mm256_permute2x128_si256(low, high, 0x31));
}

static inline vec_u8 vec_u8_of_masks(vec_u16 a, vec_u16 b)
{
    return _mm256_permute4x64_epi64(_mm256_packs_epi16(a, b), 0xd8);
}

static inline uint8_t vec_u8_least(vec_u8 v)
{
    const __m128i m = _mm_min_epu8(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));

    return (uint8_t)_mm_cvtsi128_si32(_mm_minpos_epu16(_mm_min_epu8(m, _mm_srli_epi16(m, 8))));
}

static inline uint8_t vec_u8_most(vec_u8 v)
{
    return (uint8_t)~vec_u8_least(_mm256_xor_si256(v, _mm256_set1_epi8(-1)));
}

/* sum + the products of both halves of 32-bit lanes. */
static inline __m256i vec_s32_add_pairs(__m256i sum, __m256i a, __m256i b)
{
#if defined(__AVX512VNNI__) && defined(__AVX512VL__)
    return _mm256_dpwssd_epi32(sum, a, b);
#else
    return _mm256_add_epi32(sum, _mm256_madd_epi16(a, b));
#endif
}

static inline vec_u32 vec_u32_add_products(vec_u32 sum, vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d)
{
    sum.low = vec_s32_add_pairs(sum.low, _mm256_unpacklo_epi16(a, c), _mm256_unpacklo_epi16(b, d));
    sum.high =
        vec_s32_add_pairs(sum.high, _mm256_unpackhi_epi16(a, c), _mm256_unpackhi_epi16(b, d));
    return sum;
}

static inline void vec_u64_add_four(uint64_t *to, __m128i v)
{
    __m256i *at = (__m256i *)to;

    _mm256_storeu_si256(at, _mm256_add_epi64(_mm256_loadu_si256(at), _mm256_cvtepu32_epi64(v)));
}

static inline void vec_u32_add_to(uint64_t *to, vec_u32 v)
{
    vec_u64_add_four(to, _mm256_castsi256_si128(v.low));
    vec_u64_add_four(to + 4, _mm256_castsi256_si128(v.high));
    vec_u64_add_four(to + 8, _mm256_extracti128_si256(v.low, 1));
    vec_u64_add_four(to + 12, _mm256_extracti128_si256(v.high, 1));
}

#if !defined(RF_VEC_OWN_MASKS)
#include "simd/vec_mask.h"
#endif

#endif
