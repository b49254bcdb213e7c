/* yuv_pairs.h: pairs of 16-bit values in one of 32 bits, and look-ups, for encode and decode. */
#ifndef RF_KERNELS_YUV_PAIRS_H
#define RF_KERNELS_YUV_PAIRS_H

#include "kernels/kernels.h"

/* The first and the second in memory of a pair. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
enum { FIRST16 = 16, SECOND16 = 0, FIRST8 = 8, SECOND8 = 0 };
#else
enum { FIRST16 = 0, SECOND16 = 16, FIRST8 = 0, SECOND8 = 8 };
#endif

static inline uint32_t pair_of(int32_t a, int32_t b)
{
    return (uint32_t)(a & 0xffff) << FIRST16 | (uint32_t)(b & 0xffff) << SECOND16;
}

static inline int32_t sum_of(uint32_t pair)
{
    return (int32_t)((pair & 0xffff) + (pair >> 16));
}

/* Look-ups: what the compiler makes of them when it takes several together is slower. */
#if defined(__clang__)
#define UNROLLED _Pragma("unroll 8")
#else
#define UNROLLED _Pragma("GCC unroll 8")
#endif

/* n look-ups in place. */
static RF_ALWAYS_INLINE void look_up(int32_t *restrict v, const int16_t *restrict table, int n)
{
    UNROLLED
    for (int i = 0; i < n; i++)
        v[i] = table[v[i]];
}

#endif
