/* vec_neon.h: the vector operations of vec.h on NEON, AArch64 and ARMv7 alike. */
#ifndef RF_VEC_NEON_H
#define RF_VEC_NEON_H

#include <arm_neon.h>
#include <stdint.h>

enum { VEC_U16 = 8, VEC_BITS = 8 };
typedef uint16x8_t vec_u16;

static inline vec_u16 vec_u16_load(const void *p)
{
    return vld1q_u16((const uint16_t *)p);
}

static inline vec_u16 vec_u16_from_bytes(const uint8_t *p)
{
    return vmovl_u8(vld1_u8(p));
}

static inline void vec_u16_store(void *p, vec_u16 v)
{
    vst1q_u16((uint16_t *)p, v);
}

static inline vec_u16 vec_u16_set(uint16_t x)
{
    return vdupq_n_u16(x);
}

static inline vec_u16 vec_u16_add(vec_u16 a, vec_u16 b)
{
    return vaddq_u16(a, b);
}

static inline vec_u16 vec_u16_sub(vec_u16 a, vec_u16 b)
{
    return vsubq_u16(a, b);
}

static inline vec_u16 vec_u16_and(vec_u16 a, vec_u16 b)
{
    return vandq_u16(a, b);
}

static inline vec_u16 vec_u16_or(vec_u16 a, vec_u16 b)
{
    return vorrq_u16(a, b);
}

static inline vec_u16 vec_u16_without(vec_u16 a, vec_u16 b)
{
    return vbicq_u16(a, b);
}

static inline vec_u16 vec_u16_at_most(vec_u16 a, vec_u16 b)
{
    return vcleq_u16(a, b);
}

static inline vec_u16 vec_u16_xor(vec_u16 a, vec_u16 b)
{
    return veorq_u16(a, b);
}

static inline vec_u16 vec_u16_mul_high(vec_u16 a, vec_u16 b)
{
    return vcombine_u16(vshrn_n_u32(vmull_u16(vget_low_u16(a), vget_low_u16(b)), 16),
                        vshrn_n_u32(vmull_u16(vget_high_u16(a), vget_high_u16(b)), 16));
}

static inline vec_u16 vec_u16_half(vec_u16 a)
{
    return vshrq_n_u16(a, 1);
}

static inline vec_u16 vec_u16_min(vec_u16 a, vec_u16 b)
{
    return vminq_u16(a, b);
}

static inline vec_u16 vec_u16_equal(vec_u16 a, vec_u16 b)
{
    return vceqq_u16(a, b);
}

static inline uint64_t vec_u16_bits(vec_u16 mask)
{
    return vget_lane_u64(vreinterpret_u64_u8(vmovn_u16(mask)), 0);
}

static inline uint16_t vec_u16_lane0(vec_u16 a)
{
    return vgetq_lane_u16(a, 0);
}

static inline vec_u16 vec_u16_spread(vec_u16 a)
{
    return vdupq_lane_u16(vget_low_u16(a), 0);
}

/* The high half of the product first: rounding down twice is rounding down once. */
static inline vec_u16 vec_u16_offset(vec_u16 s, vec_u16 u)
{
    const int16x8_t a = vreinterpretq_s16_u16(s), b = vreinterpretq_s16_u16(u);
    const int16x8_t high =
        vcombine_s16(vshrn_n_s32(vmull_s16(vget_low_s16(a), vget_low_s16(b)), 16),
                     vshrn_n_s32(vmull_s16(vget_high_s16(a), vget_high_s16(b)), 16));

    return vreinterpretq_u16_s16(vshrq_n_s16(vaddq_s16(high, vdupq_n_s16(64)), 7));
}

static inline vec_u16 vec_u16_bytes(vec_u16 a, vec_u16 b)
{
    return vsliq_n_u16(a, b, 8);
}

static inline vec_u16 vec_u16_max(vec_u16 a, vec_u16 b)
{
    return vmaxq_u16(a, b);
}

static inline int vec_u16_any(vec_u16 a)
{
    const uint64x2_t words = vreinterpretq_u64_u16(a);

    return (vgetq_lane_u64(words, 0) | vgetq_lane_u64(words, 1)) != 0;
}

static inline vec_u16 vec_u16_even(vec_u16 a, vec_u16 b)
{
    return vuzpq_u16(a, b).val[0];
}

static inline vec_u16 vec_u16_odd(vec_u16 a, vec_u16 b)
{
    return vuzpq_u16(a, b).val[1];
}

static inline vec_u16 vec_u16_zip_low(vec_u16 a, vec_u16 b)
{
    return vzipq_u16(a, b).val[0];
}

static inline vec_u16 vec_u16_zip_high(vec_u16 a, vec_u16 b)
{
    return vzipq_u16(a, b).val[1];
}

static inline vec_u16 vec_u16_twice(vec_u16 a)
{
    return vtrnq_u16(a, a).val[0];
}

static inline void vec_u16_add_to(uint32_t *sum, vec_u16 v)
{
    vst1q_u32(sum, vaddw_u16(vld1q_u32(sum), vget_low_u16(v)));
    vst1q_u32(sum + 4, vaddw_u16(vld1q_u32(sum + 4), vget_high_u16(v)));
}

static inline vec_u16 vec_s16_less(vec_u16 a, vec_u16 b)
{
    return vcltq_s16(vreinterpretq_s16_u16(a), vreinterpretq_s16_u16(b));
}

static inline vec_u16 vec_s16_apart(vec_u16 a, vec_u16 b)
{
    return vreinterpretq_u16_s16(
        vqabsq_s16(vqsubq_s16(vreinterpretq_s16_u16(a), vreinterpretq_s16_u16(b))));
}

static inline vec_u16 vec_s16_scale(vec_u16 a, vec_u16 b)
{
    return vreinterpretq_u16_s16(vqrdmulhq_s16(vreinterpretq_s16_u16(a), vreinterpretq_s16_u16(b)));
}

static inline vec_u16 vec_s16_max(vec_u16 a, vec_u16 b)
{
    return vreinterpretq_u16_s16(vmaxq_s16(vreinterpretq_s16_u16(a), vreinterpretq_s16_u16(b)));
}

static inline int32_t vec_dot16(const int16_t *p, const int16_t *q)
{
    int32x4_t sum = vmull_s16(vld1_s16(p), vld1_s16(q));

    for (int i = 4; i < 16; i += 4)
        sum = vmlal_s16(sum, vld1_s16(p + i), vld1_s16(q + i));
#if defined(__aarch64__)
    return vaddvq_s32(sum);
#else
    int32x2_t half = vadd_s32(vget_low_s32(sum), vget_high_s32(sum));

    return vget_lane_s32(vpadd_s32(half, half), 0);
#endif
}

static inline void vec_dots4(uint16_t out[4], const uint16_t *const p[4],
                             const int16_t *const share[4])
{
    const uint16x4_t sign = vdup_n_u16(32768);
    int32x2_t sum[4];

    for (int i = 0; i < 4; i++) {
        const int16x4_t d = vreinterpret_s16_u16(veor_u16(vld1_u16(p[i]), sign));
        const int32x4_t products = vmull_s16(d, vld1_s16(share[i]));

        sum[i] = vadd_s32(vget_low_s32(products), vget_high_s32(products));
    }
    const int32x4_t sums = vcombine_s32(vpadd_s32(sum[0], sum[1]), vpadd_s32(sum[2], sum[3]));

    vst1_u16(out, veor_u16(vreinterpret_u16_s16(vqrshrn_n_s32(sums, 15)), sign));
}

static inline vec_u16 vec_u16_cubic4(vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d,
                                     const int16_t share[4])
{
    const uint16x8_t sign = vdupq_n_u16(0x8000);
    const int16x8_t p[4] = {
        vreinterpretq_s16_u16(veorq_u16(a, sign)), vreinterpretq_s16_u16(veorq_u16(b, sign)),
        vreinterpretq_s16_u16(veorq_u16(c, sign)), vreinterpretq_s16_u16(veorq_u16(d, sign))};
    int32x4_t low = vmull_n_s16(vget_low_s16(p[0]), share[0]);
    int32x4_t high = vmull_n_s16(vget_high_s16(p[0]), share[0]);

    for (int k = 1; k < 4; k++) {
        low = vmlal_n_s16(low, vget_low_s16(p[k]), share[k]);
        high = vmlal_n_s16(high, vget_high_s16(p[k]), share[k]);
    }
    return veorq_u16(
        vreinterpretq_u16_s16(vcombine_s16(vqrshrn_n_s32(low, 14), vqrshrn_n_s32(high, 14))), sign);
}

static inline uint32_t vec_within16(const uint16_t *p, uint16_t low, uint16_t width)
{
    static const uint8_t bits[16] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint16x8_t a = vcleq_u16(vsubq_u16(vld1q_u16(p), vdupq_n_u16(low)), vdupq_n_u16(width));
    const uint16x8_t b =
        vcleq_u16(vsubq_u16(vld1q_u16(p + 8), vdupq_n_u16(low)), vdupq_n_u16(width));
    const uint8x16_t m = vandq_u8(vcombine_u8(vmovn_u16(a), vmovn_u16(b)), vld1q_u8(bits));
    uint8x8_t sum = vpadd_u8(vget_low_u8(m), vget_high_u8(m));

    sum = vpadd_u8(sum, sum);
    return vget_lane_u16(vreinterpret_u16_u8(vpadd_u8(sum, sum)), 0);
}

static inline uint64_t vec_within64(const uint16_t *p, uint16_t low, uint16_t width)
{
    uint64_t bits = 0;

    for (int i = 0; i < 64; i += 16)
        bits |= (uint64_t)vec_within16(p + i, low, width) << i;
    return bits;
}

static inline vec_u16 vec_u16_select(vec_u16 m, vec_u16 a, vec_u16 b)
{
    return vbslq_u16(m, a, b);
}

static inline vec_u16 vec_u16_mul(vec_u16 a, vec_u16 b)
{
    return vmulq_u16(a, b);
}

enum { VEC_U8 = 16 };
typedef uint8x16_t vec_u8;

static inline vec_u8 vec_u8_load(const void *p)
{
    return vld1q_u8((const uint8_t *)p);
}

static inline vec_u8 vec_u8_set(uint8_t x)
{
    return vdupq_n_u8(x);
}

static inline vec_u8 vec_u8_apart(vec_u8 a, vec_u8 b)
{
    return vabdq_u8(a, b);
}

static inline vec_u8 vec_u8_adds(vec_u8 a, vec_u8 b)
{
    return vqaddq_u8(a, b);
}

static inline vec_u8 vec_u8_subs(vec_u8 a, vec_u8 b)
{
    return vqsubq_u8(a, b);
}

static inline vec_u8 vec_u8_table(const uint8_t *p)
{
    return vld1q_u8(p);
}

/* A table has 16 entries, and there is nothing beyond. */
static inline vec_u8 vec_u8_lookup_or_0(vec_u8 table, vec_u8 v)
{
#if defined(__aarch64__)
    return vqtbl1q_u8(table, v);
#else
    const uint8x8x2_t halves = {{vget_low_u8(table), vget_high_u8(table)}};

    return vcombine_u8(vtbl2_u8(halves, vget_low_u8(v)), vtbl2_u8(halves, vget_high_u8(v)));
#endif
}

static inline void vec_u8_add_wide(vec_u16 sum[2], vec_u8 v)
{
    sum[0] = vaddw_u8(sum[0], vget_low_u8(v));
    sum[1] = vaddw_u8(sum[1], vget_high_u8(v));
}

static inline void vec_u8_store(void *p, vec_u8 v)
{
    vst1q_u8((uint8_t *)p, v);
}

static inline void vec_u8_store_wide(uint16_t *p, const vec_u16 sum[2])
{
    vec_u16_store(p, sum[0]);
    vec_u16_store(p + 8, sum[1]);
}

static inline vec_u8 vec_u8_of_masks(vec_u16 a, vec_u16 b)
{
    return vcombine_u8(vmovn_u16(a), vmovn_u16(b));
}

static inline uint8_t vec_u8_least(vec_u8 v)
{
#if defined(__aarch64__)
    return vminvq_u8(v);
#else
    uint8x8_t m = vpmin_u8(vget_low_u8(v), vget_high_u8(v));

    m = vpmin_u8(m, m);
    m = vpmin_u8(m, m);
    return vget_lane_u8(vpmin_u8(m, m), 0);
#endif
}

static inline uint8_t vec_u8_most(vec_u8 v)
{
    return (uint8_t)~vec_u8_least(vmvnq_u8(v));
}

static inline uint64_t vec_u8_bits_at_most(vec_u8 a, vec_u8 b)
{
    static const uint8_t bits[16] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t m = vandq_u8(vcleq_u8(a, b), vld1q_u8(bits));
    uint8x8_t sum = vpadd_u8(vget_low_u8(m), vget_high_u8(m));

    sum = vpadd_u8(sum, sum);
    return vget_lane_u16(vreinterpret_u16_u8(vpadd_u8(sum, sum)), 0);
}

typedef struct {
    uint32x4_t low, high;
} vec_u32;

static inline vec_u32 vec_u32_zero(void)
{
    return (vec_u32){vdupq_n_u32(0), vdupq_n_u32(0)};
}

static inline vec_u32 vec_u32_add_products(vec_u32 sum, vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d)
{
    sum.low = vmlal_u16(sum.low, vget_low_u16(a), vget_low_u16(b));
    sum.high = vmlal_u16(sum.high, vget_high_u16(a), vget_high_u16(b));
    sum.low = vmlal_u16(sum.low, vget_low_u16(c), vget_low_u16(d));
    sum.high = vmlal_u16(sum.high, vget_high_u16(c), vget_high_u16(d));
    return sum;
}

static inline void vec_u64_add_four(uint64_t *to, uint32x4_t v)
{
    vst1q_u64(to, vaddw_u32(vld1q_u64(to), vget_low_u32(v)));
    vst1q_u64(to + 2, vaddw_u32(vld1q_u64(to + 2), vget_high_u32(v)));
}

static inline void vec_u32_add_to(uint64_t *to, vec_u32 v)
{
    vec_u64_add_four(to, v.low);
    vec_u64_add_four(to + 4, v.high);
}

#include "simd/vec_mask.h"

#endif
