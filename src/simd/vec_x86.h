/* vec_x86.h: the vector operations of vec.h that vec_sse41.h and vec_avx2.h do alike.
 *
 * Both define vec_u16, vec_u8 and vec_u32 before, and how an intrinsic is called on their
 * registers: VEC_LANES(add_epi16) is _mm_add_epi16 or _mm256_add_epi16, VEC_WHOLE(or) is
 * _mm_or_si128 or _mm256_or_si256. */
#ifndef RF_VEC_X86_H
#define RF_VEC_X86_H

#include <immintrin.h>
#include <stdint.h>

/* Two numbers of 16 bits for the halves of a lane of 32. */
static inline int vec_pair(int16_t low, int16_t high)
{
    return (int)((uint32_t)(uint16_t)high << 16 | (uint16_t)low);
}

/* Two groups of four elements, 2^15 less. */
static inline __m128i vec_two_fours(const uint16_t *a, const uint16_t *b)
{
    const __m128i pair = _mm_unpacklo_epi64(_mm_loadl_epi64((const __m128i *)a),
                                            _mm_loadl_epi64((const __m128i *)b));

    return _mm_xor_si128(pair, _mm_set1_epi16(-32768));
}

static inline void vec_dots4(uint16_t out[4], const uint16_t *const p[4],
                             const int16_t *const share[4])
{
    const __m128i a = _mm_madd_epi16(
        vec_two_fours(p[0], p[1]), _mm_unpacklo_epi64(_mm_loadl_epi64((const __m128i *)share[0]),
                                                      _mm_loadl_epi64((const __m128i *)share[1])));
    const __m128i b = _mm_madd_epi16(
        vec_two_fours(p[2], p[3]), _mm_unpacklo_epi64(_mm_loadl_epi64((const __m128i *)share[2]),
                                                      _mm_loadl_epi64((const __m128i *)share[3])));
    const __m128i sum =
        _mm_srai_epi32(_mm_add_epi32(_mm_hadd_epi32(a, b), _mm_set1_epi32(1 << 14)), 15);

    _mm_storel_epi64((__m128i *)out,
                     _mm_xor_si128(_mm_packs_epi32(sum, sum), _mm_set1_epi16(-32768)));
}

static inline vec_u16 vec_u16_load(const void *p)
{
    return VEC_WHOLE(loadu)((const vec_u16 *)p);
}

static inline void vec_u16_store(void *p, vec_u16 v)
{
    VEC_WHOLE(storeu)((vec_u16 *)p, v);
}

static inline vec_u16 vec_u16_set(uint16_t x)
{
    return VEC_LANES(set1_epi16)((int16_t)x);
}

static inline vec_u16 vec_u16_add(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(add_epi16)(a, b);
}

static inline vec_u16 vec_u16_sub(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(sub_epi16)(a, b);
}

static inline vec_u16 vec_u16_and(vec_u16 a, vec_u16 b)
{
    return VEC_WHOLE(and)(a, b);
}

static inline vec_u16 vec_u16_or(vec_u16 a, vec_u16 b)
{
    return VEC_WHOLE(or)(a, b);
}

static inline vec_u16 vec_u16_without(vec_u16 a, vec_u16 b)
{
    return VEC_WHOLE(andnot)(b, a);
}

static inline vec_u16 vec_u16_at_most(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(cmpeq_epi16)(VEC_LANES(min_epu16)(a, b), a);
}

static inline vec_u16 vec_u16_xor(vec_u16 a, vec_u16 b)
{
    return VEC_WHOLE(xor)(a, b);
}

static inline vec_u16 vec_u16_mul_high(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(mulhi_epu16)(a, b);
}

static inline vec_u16 vec_u16_half(vec_u16 a)
{
    return VEC_LANES(srli_epi16)(a, 1);
}

static inline vec_u16 vec_u16_min(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(min_epu16)(a, b);
}

static inline vec_u16 vec_u16_equal(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(cmpeq_epi16)(a, b);
}

static inline uint64_t vec_u16_bits(vec_u16 mask)
{
    return (uint32_t)VEC_LANES(movemask_epi8)(mask);
}

static inline vec_u16 vec_u16_offset(vec_u16 s, vec_u16 u)
{
    return VEC_LANES(srai_epi16)(
        VEC_LANES(add_epi16)(VEC_LANES(mulhi_epi16)(s, u), VEC_LANES(set1_epi16)(64)), 7);
}

static inline vec_u16 vec_u16_bytes(vec_u16 a, vec_u16 b)
{
    return VEC_WHOLE(or)(VEC_WHOLE(and)(a, VEC_LANES(set1_epi16)(0xff)),
                         VEC_LANES(slli_epi16)(b, 8));
}

static inline vec_u16 vec_u16_max(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(max_epu16)(a, b);
}

static inline int vec_u16_any(vec_u16 a)
{
    return !VEC_WHOLE(testz)(a, a);
}

static inline vec_u16 vec_u16_twice(vec_u16 a)
{
    return VEC_LANES(blend_epi16)(a, VEC_LANES(slli_epi32)(a, 16), 0xaa);
}

static inline vec_u16 vec_s16_less(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(cmpgt_epi16)(b, a);
}

static inline vec_u16 vec_s16_apart(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(max_epi16)(VEC_LANES(subs_epi16)(a, b), VEC_LANES(subs_epi16)(b, a));
}

static inline vec_u16 vec_s16_scale(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(mulhrs_epi16)(a, b);
}

static inline vec_u16 vec_s16_max(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(max_epi16)(a, b);
}

/* Both halves of registers unpack and pack alike: lanes stay where they were. */
static inline vec_u16 vec_u16_cubic4(vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d,
                                     const int16_t share[4])
{
    const vec_u16 sign = VEC_LANES(set1_epi16)(-32768), half = VEC_LANES(set1_epi32)(1 << 13);
    const vec_u16 ab = VEC_LANES(set1_epi32)(vec_pair(share[0], share[1]));
    const vec_u16 cd = VEC_LANES(set1_epi32)(vec_pair(share[2], share[3]));
    vec_u16 low, high;

    a = VEC_WHOLE(xor)(a, sign);
    b = VEC_WHOLE(xor)(b, sign);
    c = VEC_WHOLE(xor)(c, sign);
    d = VEC_WHOLE(xor)(d, sign);
    low = VEC_LANES(add_epi32)(VEC_LANES(madd_epi16)(VEC_LANES(unpacklo_epi16)(a, b), ab),
                               VEC_LANES(madd_epi16)(VEC_LANES(unpacklo_epi16)(c, d), cd));
    high = VEC_LANES(add_epi32)(VEC_LANES(madd_epi16)(VEC_LANES(unpackhi_epi16)(a, b), ab),
                                VEC_LANES(madd_epi16)(VEC_LANES(unpackhi_epi16)(c, d), cd));
    low = VEC_LANES(srai_epi32)(VEC_LANES(add_epi32)(low, half), 14);
    high = VEC_LANES(srai_epi32)(VEC_LANES(add_epi32)(high, half), 14);
    return VEC_WHOLE(xor)(VEC_LANES(packs_epi32)(low, high), sign);
}

static inline vec_u16 vec_u16_select(vec_u16 m, vec_u16 a, vec_u16 b)
{
    return VEC_LANES(blendv_epi8)(b, a, m);
}

static inline vec_u16 vec_u16_mul(vec_u16 a, vec_u16 b)
{
    return VEC_LANES(mullo_epi16)(a, b);
}

static inline vec_u8 vec_u8_load(const void *p)
{
    return VEC_WHOLE(loadu)((const vec_u8 *)p);
}

static inline vec_u8 vec_u8_set(uint8_t x)
{
    return VEC_LANES(set1_epi8)((char)x);
}

static inline vec_u8 vec_u8_apart(vec_u8 a, vec_u8 b)
{
    return VEC_LANES(abs_epi8)(VEC_LANES(sub_epi8)(a, b));
}

static inline vec_u8 vec_u8_adds(vec_u8 a, vec_u8 b)
{
    return VEC_LANES(adds_epu8)(a, b);
}

static inline vec_u8 vec_u8_subs(vec_u8 a, vec_u8 b)
{
    return VEC_LANES(subs_epu8)(a, b);
}

/* A lane whose highest bit is set is shuffled to 0. */
static inline vec_u8 vec_u8_lookup_or_0(vec_u8 table, vec_u8 v)
{
    return VEC_LANES(shuffle_epi8)(table, VEC_LANES(adds_epu8)(v, VEC_LANES(set1_epi8)(112)));
}

/* Sums of even lanes + 2^8 odd ones, and of odd ones. */
static inline void vec_u8_add_wide(vec_u16 sum[2], vec_u8 v)
{
    sum[0] = VEC_LANES(add_epi16)(sum[0], v);
    sum[1] = VEC_LANES(add_epi16)(sum[1], VEC_LANES(srli_epi16)(v, 8));
}

static inline void vec_u8_store(void *p, vec_u8 v)
{
    VEC_WHOLE(storeu)((vec_u8 *)p, v);
}

static inline uint64_t vec_u8_bits_at_most(vec_u8 a, vec_u8 b)
{
    return (uint32_t)VEC_LANES(movemask_epi8)(VEC_LANES(cmpeq_epi8)(VEC_LANES(min_epu8)(a, b), a));
}

static inline vec_u32 vec_u32_zero(void)
{
    return (vec_u32){VEC_WHOLE(setzero)(), VEC_WHOLE(setzero)()};
}

#endif
