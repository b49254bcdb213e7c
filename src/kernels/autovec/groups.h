/* groups.h: operations on groups of 16 and 64 elements, those of simd/vec.h or plain C. */
#ifndef RF_KERNELS_GROUPS_H
#define RF_KERNELS_GROUPS_H

#include <stdint.h>

#include "simd/vec.h"

#if defined(RF_VECTORS)

static inline uint64_t rf_within16(const uint16_t *p, uint16_t low, uint16_t width)
{
    return vec_within16(p, low, width);
}

static inline uint64_t rf_within64(const uint16_t *p, uint16_t low, uint16_t width)
{
    return vec_within64(p, low, width);
}

static inline int rf_dot16(const int16_t *p, const int16_t *q)
{
    return vec_dot16(p, q);
}

#else

/* Bit i tells whether element i lies from low to low + width. */
static inline uint64_t rf_within16(const uint16_t *p, uint16_t low, uint16_t width)
{
    uint64_t bits = 0;

    for (int i = 0; i < 16; i++)
        bits |= (uint64_t)((uint16_t)(p[i] - low) <= width) << i;
    return bits;
}

static inline uint64_t rf_within64(const uint16_t *p, uint16_t low, uint16_t width)
{
    uint64_t bits = 0;

    for (int i = 0; i < 64; i += 16)
        bits |= rf_within16(p + i, low, width) << i;
    return bits;
}

static inline int rf_dot16(const int16_t *restrict p, const int16_t *restrict q)
{
    int sum = 0;

    for (int i = 0; i < 16; i++)
        sum += p[i] * q[i];
    return sum;
}

#endif

#endif
