/* vec_weigh4.h: what AVX2 and SSE4.1 make of vec_weigh4() alike. */
#ifndef RF_VEC_WEIGH4_H
#define RF_VEC_WEIGH4_H

static inline vec_u16 vec_u16_mix4(vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d,
                                   const int16_t share[4])
{
    return vec_weigh4(a, b, c, d, share, 15);
}

static inline vec_u16 vec_u16_cubic4(vec_u16 a, vec_u16 b, vec_u16 c, vec_u16 d,
                                     const int16_t share[4])
{
    return vec_weigh4(a, b, c, d, share, 14);
}

#endif
