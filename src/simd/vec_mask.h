/* vec_mask.h: masks of vec.h where instructions take them from vectors, all bits of a lane set
 * or none. */
#ifndef RF_VEC_MASK_H
#define RF_VEC_MASK_H

typedef vec_u16 vec_mask;

static inline vec_mask vec_mask_all(void)
{
    return vec_u16_set(0xffff);
}

static inline vec_mask vec_mask_less(vec_mask among, vec_u16 a, vec_u16 b)
{
    return vec_u16_and(among, vec_s16_less(a, b));
}

static inline vec_mask vec_mask_without(vec_mask a, vec_mask b)
{
    return vec_u16_without(a, b);
}

static inline vec_u16 vec_u16_add_where(vec_mask mask, vec_u16 sum, vec_u16 v)
{
    return vec_u16_add(sum, vec_u16_and(v, mask));
}

static inline vec_u16 vec_u16_put_where(vec_mask mask, vec_u16 old, vec_u16 v)
{
    return vec_u16_or(old, vec_u16_and(v, mask));
}

#endif
