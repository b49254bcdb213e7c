/* vec_x86.h: what vec_sse41.h and vec_avx2.h do on 128-bit registers alike. */
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

#endif
