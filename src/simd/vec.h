/* vec.h: the vector operations that kernels are written on, with their meaning in C.
 *
 * Each instruction set has a header of them, vec_NAME.h, and kernels/NAME_vec.c is compiled once
 * with each. A vector holds VEC_U16 lanes of 16 bits.
 *
 *     vec_u16_load(p)         lane i = p[i], any alignment of whole elements
 *     vec_u16_from_bytes(p)   lane i = p[i], of bytes
 *     vec_u16_store(p, v)     p[i] = lane i
 *     vec_u16_set(x)          every lane = x
 *     vec_u16_add(a, b)       (uint16_t)(a + b)
 *     vec_u16_sub(a, b)       (uint16_t)(a - b)
 *     vec_u16_and(a, b)       a & b
 *     vec_u16_or(a, b)        a | b
 *     vec_u16_without(a, b)   a & ~b
 *     vec_u16_mul(a, b)       (uint16_t)(a * b)
 *     vec_u16_at_most(a, b)   a <= b ? 0xffff : 0
 *     vec_u16_xor(a, b)       a ^ b
 *     vec_u16_mul_high(a, b)  (a * b) >> 16
 *     vec_u16_half(a)         a >> 1
 *     vec_u16_max(a, b)       a > b ? a : b
 *     vec_u16_min(a, b)       a < b ? a : b
 *     vec_u16_equal(a, b)     a == b ? 0xffff : 0
 *     vec_u16_any(a)          whether any lane is not 0
 *     vec_u16_bits(mask)      VEC_BITS bits a lane, lane 0 lowest, of lanes all 0 or all 1
 *     vec_u16_lane0(a)        lane 0
 *     vec_u16_spread(a)       every lane = lane 0
 *     vec_u16_offset(s, u)    of signed lanes: (s * u + 2^22) >> 23
 *     vec_u16_bytes(a, b)     (a & 0xff) | b << 8
 *     vec_u16_even(a, b)      lanes 0, 2, 4 ... of a and then of b
 *     vec_u16_odd(a, b)       lanes 1, 3, 5 ...
 *     vec_u16_zip_low(a, b)   a[0], b[0], a[1], b[1] ... of the lower halves
 *     vec_u16_zip_high(a, b)  and of the upper ones
 *     vec_u16_twice(a)        a[0], a[0], a[2], a[2] ...
 *     vec_u16_add_to(sum, v)  sum[i] += v[i], 32-bit sums
 *     vec_s16_less(a, b)      (int16_t)a < (int16_t)b ? 0xffff : 0
 *     vec_s16_apart(a, b)     min(|a - b|, 32767) of signed lanes
 *     vec_s16_max(a, b)       the greater of signed lanes
 *     vec_s16_scale(a, b)     of signed lanes: (a * b + 2^14) >> 15; not both are -2^15
 *     vec_u16_select(m, a, b) m ? a : b, for lanes of m that are 0xffff or 0
 *     vec_within16(p, low, width)
 *                             bit i: (uint16_t)(p[i] - low) <= width, of 16 elements
 *     vec_within64(p, low, width)
 *                             the same of 64 elements
 *     vec_dot16(p, q)         sum of p[i] * q[i] of 16 signed elements, of 32 bits
 *     vec_dots4(out, p, share)
 *                             of four groups of four elements: out[i] = 2^15 +
 *                             (sum of (p[i][k] - 2^15) * share[i][k] + 2^14) >> 15, shares not
 *                             negative and of sum 2^15
 *     vec_u16_cubic4(a, b, c, d, share)
 *                             2^15 + ((sum of (p - 2^15) * share + 2^13) >> 14) of a lane p of
 *                             each, or the nearest of 0 and 65535; magnitudes of shares add up
 *                             to less than 2^15
 *
 * A vec_mask has lanes that are on or off:
 *
 *     vec_mask_all()          all of them on
 *     vec_mask_less(m, a, b)  those of m where (int16_t)a < (int16_t)b
 *     vec_mask_equal(m, a, b) those of m where a == b
 *     vec_mask_without(m, n)  those of m that are off in n
 *     vec_mask_or(m, n)       those on in either
 *     vec_mask_any(m)         whether any is on
 *     vec_mask_first(m)       the number of the first that is on, of the last lane if none
 *     vec_u16_add_where(m, a, b)  m ? (uint16_t)(a + b) : a
 *     vec_u16_choose(m, a, b)     m ? a : b
 *     vec_u16_load_where(m, a, p) m ? p[i] : a; whole vectors of p are there
 *     vec_u16_put_where(m, a, b)  m ? b : a, where a is 0 in the lanes of m
 *
 * A vec_u32 holds as many lanes of 32 bits, in an order of its own.
 *
 *     vec_u32_zero()          every lane = 0
 *     vec_u32_add_products(sum, a, b, c, d)
 *                             sum + a * b + c * d, factors below 2^15;
 *                             sums below 2^32
 *     vec_u32_add_to(to, v)   to[i] += v[i], 64-bit sums
 *
 * and VEC_U8 = 2 VEC_U16 lanes of bytes:
 *
 *     vec_u8_load(p)          lane i = p[i]
 *     vec_u8_store(p, v)      p[i] = lane i
 *     vec_u8_set(x)           every lane = x
 *     vec_u8_apart(a, b)      |a - b|, where both are below 128
 *     vec_u8_adds(a, b)       min(a + b, 255)
 *     vec_u8_subs(a, b)       max(a - b, 0)
 *     vec_u8_table(p)         the table p[0] to p[15]
 *     vec_u8_lookup_or_0(table, v)  v < 16 ? table[v] : 0, v any
 *     vec_u8_of_masks(a, b)   0 or 255 for lanes of a and then of b that are 0 or 0xffff
 *     vec_u8_least(v), vec_u8_most(v)  of all lanes
 *     vec_u8_bits_at_most(a, b)  bit i: a[i] <= b[i]
 *     vec_u8_add_wide(sum, v) two vectors of 16-bit sums, in an order of their own, += v
 *     vec_u8_store_wide(p, sum)  p[i] = the sum of lane i
 */
#ifndef RF_VEC_H
#define RF_VEC_H

/* The build names the header of the instruction set; plain C has none. */
#if defined(RF_VEC_HEADER)
#define RF_VECTORS
#include RF_VEC_HEADER
#endif

#endif
