/* cubic.h: cubic interpolation of a row of a tile between four rows that were computed. */
#ifndef RF_CUBIC_H
#define RF_CUBIC_H

#include "kernels/kernels.h"
#include "simd/vec.h"

/* A row of a tile on the cubic through four rows from `row` on, shares in Q14 that add up to 1,
 * half up, but not beyond `before` and the row after it. */
static inline void rf_cubic_row(uint16_t *restrict mean, const uint16_t *restrict row,
                                const uint16_t *restrict before, const int16_t share[4])
{
#if defined(RF_VECTORS)
    for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
        const vec_u16 a = vec_u16_load(before + x), b = vec_u16_load(before + RF_TILE + x);
        const vec_u16 v = vec_u16_cubic4(vec_u16_load(row + x), vec_u16_load(row + RF_TILE + x),
                                         vec_u16_load(row + 2 * RF_TILE + x),
                                         vec_u16_load(row + 3 * RF_TILE + x), share);

        vec_u16_store(mean + x, vec_u16_min(vec_u16_max(v, vec_u16_min(a, b)), vec_u16_max(a, b)));
    }
#else
    const int32_t s0 = share[0], s1 = share[1], s2 = share[2], s3 = share[3];

    for (int x = 0; x < RF_TILE; x++) {
        const int32_t v = (s0 * row[x] + s1 * row[x + RF_TILE] + s2 * row[x + 2 * RF_TILE] +
                           s3 * row[x + 3 * RF_TILE] + 8192) >>
                          14;
        const int32_t a = before[x], b = before[x + RF_TILE];
        const int32_t low = a < b ? a : b, high = a < b ? b : a;

        mean[x] = (uint16_t)(v < low ? low : v > high ? high : v);
    }
#endif
}

#endif
