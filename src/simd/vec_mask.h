/* vec_mask.h: masks of vec.h where instructions take them from vectors, all bits of a lane set
 * or none. */
#ifndef RF_VEC_MASK_H
#define RF_VEC_MASK_H

#include <stdbool.h>

typedef vec_u16 vec_mask;

static inline vec_mask vec_mask_all(void)
{
    return vec_u16_set(0xffff);
}

static inline vec_mask vec_mask_less(vec_mask among, vec_u16 a, vec_u16 b)
{
    return vec_u16_and(among, vec_s16_less(a, b));
}

static inline vec_mask vec_mask_equal(vec_mask among, vec_u16 a, vec_u16 b)
{
    return vec_u16_and(among, vec_u16_equal(a, b));
}

static inline vec_mask vec_mask_or(vec_mask a, vec_mask b)
{
    return vec_u16_or(a, b);
}

static inline bool vec_mask_any(vec_mask m)
{
    return vec_u16_bits(m) != 0;
}

static inline int vec_mask_first(vec_mask m)
{
    const uint64_t last = UINT64_C(1) << (VEC_U16 - 1) * VEC_BITS;

    return __builtin_ctzll(vec_u16_bits(m) | last) / VEC_BITS;
}

static inline vec_u16 vec_u16_choose(vec_mask mask, vec_u16 a, vec_u16 b)
{
    return vec_u16_select(mask, a, b);
}

static inline vec_mask vec_mask_without(vec_mask a, vec_mask b)
{
    return vec_u16_without(a, b);
}

static inline vec_u16 vec_u16_add_where(vec_mask mask, vec_u16 sum, vec_u16 v)
{
    return vec_u16_add(sum, vec_u16_and(v, mask));
}

static inline vec_u16 vec_u16_load_where(vec_mask mask, vec_u16 old, const void *p)
{
    return vec_u16_select(mask, vec_u16_load(p), old);
}

static inline vec_u16 vec_u16_put_where(vec_mask mask, vec_u16 old, vec_u16 v)
{
    return vec_u16_or(old, vec_u16_and(v, mask));
}

#endif
