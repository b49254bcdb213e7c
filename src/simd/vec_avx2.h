/* vec_avx2.h: the vector operations of vec.h on 256-bit registers. */
#ifndef RF_VEC_AVX2_H
#define RF_VEC_AVX2_H

#include <immintrin.h>
#include <stdint.h>

#include "simd/vec_x86.h"

enum { VEC_U16 = 16, VEC_BITS = 2 };
typedef __m256i vec_u16;

static inline vec_u16 vec_u16_load(const void *p)
{
    return _mm256_loadu_si256((const __m256i *)p);
}

static inline vec_u16 vec_u16_from_bytes(const uint8_t *p)
{
    return _mm256_cvtepu8_epi16(_mm_loadu_si128((const __m128i *)p));
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

static inline vec_u16 vec_u16_or(vec_u16 a, vec_u16 b)
{
    return _mm256_or_si256(a, b);
}

static inline vec_u16 vec_u16_without(vec_u16 a, vec_u16 b)
{
    return _mm256_andnot_si256(b, a);
}

static inline vec_u16 vec_u16_at_most(vec_u16 a, vec_u16 b)
{
    return _mm256_cmpeq_epi16(_mm256_min_epu16(a, b), a);
}

static inline vec_u16 vec_u16_xor(vec_u16 a, vec_u16 b)
{
    return _mm256_xor_si256(a, b);
}

static inline vec_u16 vec_u16_mul_high(vec_u16 a, vec_u16 b)
{
    return _mm256_mulhi_epu16(a, b);
}

static inline vec_u16 vec_u16_half(vec_u16 a)
{
    return _mm256_srli_epi16(a, 1);
}

static inline vec_u16 vec_u16_min(vec_u16 a, vec_u16 b)
{
    return _mm256_min_epu16(a, b);
}

static inline vec_u16 vec_u16_equal(vec_u16 a, vec_u16 b)
{
    return _mm256_cmpeq_epi16(a, b);
}

static inline uint64_t vec_u16_bits(vec_u16 mask)
{
    return (uint32_t)_mm256_movemask_epi8(mask);
}

static inline uint16_t vec_u16_lane0(vec_u16 a)
{
    return (uint16_t)_mm_cvtsi128_si32(_mm256_castsi256_si128(a));
}

static inline vec_u16 vec_u16_spread(vec_u16 a)
{
    return _mm256_broadcastw_epi16(_mm256_castsi256_si128(a));
}

static inline vec_u16 vec_u16_offset(vec_u16 s, vec_u16 u)
{
    return _mm256_srai_epi16(_mm256_add_epi16(_mm256_mulhi_epi16(s, u), _mm256_set1_epi16(64)), 7);
}

static inline vec_u16 vec_u16_bytes(vec_u16 a, vec_u16 b)
{
    return _mm256_or_si256(_mm256_and_si256(a, _mm256_set1_epi16(0xff)), _mm256_slli_epi16(b, 8));
}

static inline vec_u16 vec_u16_max(vec_u16 a, vec_u16 b)
{
    return _mm256_max_epu16(a, b);
}

static inline int vec_u16_any(vec_u16 a)
{
    return !_mm256_testz_si256(a, a);
}

static inline uint16_t vec_u16_greatest(vec_u16 a)
{
    const __m128i all = _mm_max_epu16(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));

    return (uint16_t)~_mm_extract_epi16(_mm_minpos_epu16(_mm_xor_si128(all, _mm_set1_epi8(-1))), 0);
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

static inline vec_u16 vec_u16_twice(vec_u16 a)
{
    return _mm256_blend_epi16(a, _mm256_slli_epi32(a, 16), 0xaa);
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

static inline vec_u16 vec_s16_apart(vec_u16 a, vec_u16 b)
{
    return _mm256_max_epi16(_mm256_subs_epi16(a, b), _mm256_subs_epi16(b, a));
}

static inline vec_u16 vec_s16_scale(vec_u16 a, vec_u16 b)
{
    return _mm256_mulhrs_epi16(a, b);
}

static inline vec_u16 vec_s16_max(vec_u16 a, vec_u16 b)
{
    return _mm256_max_epi16(a, b);
}

static inline int32_t vec_dot16(const int16_t *p, const int16_t *q)
{
    const __m256i sum = _mm256_madd_epi16(vec_u16_load(p), vec_u16_load(q));
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));

    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    return _mm_cvtsi128_si32(_mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1)));
}

/* Both halves of registers unpack and pack alike: lanes stay where they were. */
static inline vec_u16 vec_weigh4(vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d, const int16_t share[4],
                                 const int shift)
{
    const __m256i sign = _mm256_set1_epi16(-32768), half = _mm256_set1_epi32(1 << (shift - 1));
    const __m256i ab = _mm256_set1_epi32(vec_pair(share[0], share[1]));
    const __m256i cd = _mm256_set1_epi32(vec_pair(share[2], share[3]));
    __m256i low, high;

    a = _mm256_xor_si256(a, sign);
    b = _mm256_xor_si256(b, sign);
    c = _mm256_xor_si256(c, sign);
    d = _mm256_xor_si256(d, sign);
    low = _mm256_add_epi32(_mm256_madd_epi16(_mm256_unpacklo_epi16(a, b), ab),
                           _mm256_madd_epi16(_mm256_unpacklo_epi16(c, d), cd));
    high = _mm256_add_epi32(_mm256_madd_epi16(_mm256_unpackhi_epi16(a, b), ab),
                            _mm256_madd_epi16(_mm256_unpackhi_epi16(c, d), cd));
    low = _mm256_srai_epi32(_mm256_add_epi32(low, half), shift);
    high = _mm256_srai_epi32(_mm256_add_epi32(high, half), shift);
    return _mm256_xor_si256(_mm256_packs_epi32(low, high), sign);
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

static inline vec_u16 vec_u16_select(vec_u16 m, vec_u16 a, vec_u16 b)
{
    return _mm256_blendv_epi8(b, a, m);
}

static inline vec_u16 vec_u16_mul(vec_u16 a, vec_u16 b)
{
    return _mm256_mullo_epi16(a, b);
}

enum { VEC_U8 = 32 };
typedef __m256i vec_u8;

static inline vec_u8 vec_u8_load(const void *p)
{
    return _mm256_loadu_si256((const __m256i *)p);
}

static inline vec_u8 vec_u8_set(uint8_t x)
{
    return _mm256_set1_epi8((char)x);
}

static inline vec_u8 vec_u8_absdiff(vec_u8 a, vec_u8 b)
{
    return _mm256_or_si256(_mm256_subs_epu8(a, b), _mm256_subs_epu8(b, a));
}

static inline vec_u8 vec_u8_apart(vec_u8 a, vec_u8 b)
{
    return _mm256_abs_epi8(_mm256_sub_epi8(a, b));
}

static inline vec_u8 vec_u8_adds(vec_u8 a, vec_u8 b)
{
    return _mm256_adds_epu8(a, b);
}

static inline vec_u8 vec_u8_subs(vec_u8 a, vec_u8 b)
{
    return _mm256_subs_epu8(a, b);
}

static inline vec_u8 vec_u8_half(vec_u8 v)
{
    return _mm256_and_si256(_mm256_srli_epi16(v, 1), _mm256_set1_epi8(127));
}

static inline vec_u8 vec_u8_table(const uint8_t *p)
{
    return _mm256_broadcastsi128_si256(_mm_loadu_si128((const __m128i *)p));
}

static inline vec_u8 vec_u8_lookup(vec_u8 table, vec_u8 v)
{
    return _mm256_shuffle_epi8(table, v);
}

/* A lane whose highest bit is set is shuffled to 0. */
static inline vec_u8 vec_u8_lookup_or_0(vec_u8 table, vec_u8 v)
{
    return _mm256_shuffle_epi8(table, _mm256_adds_epu8(v, _mm256_set1_epi8(112)));
}

/* Sums of even lanes + 2^8 odd ones, and of odd ones. */
static inline void vec_u8_add_wide(vec_u16 sum[2], vec_u8 v)
{
    sum[0] = _mm256_add_epi16(sum[0], v);
    sum[1] = _mm256_add_epi16(sum[1], _mm256_srli_epi16(v, 8));
}

static inline void vec_u8_store(void *p, vec_u8 v)
{
    _mm256_storeu_si256((__m256i *)p, v);
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

static inline uint64_t vec_u8_bits_at_most(vec_u8 a, vec_u8 b)
{
    return (uint32_t)_mm256_movemask_epi8(_mm256_cmpeq_epi8(_mm256_min_epu8(a, b), a));
}

/* Lanes 0-3 and 8-11, and 4-7 and 12-15: as unpacking leaves them. */
typedef struct {
    __m256i low, high;
} vec_u32;

static inline vec_u32 vec_u32_zero(void)
{
    return (vec_u32){_mm256_setzero_si256(), _mm256_setzero_si256()};
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
#include "simd/vec_weigh4.h"

#endif
