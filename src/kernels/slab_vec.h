/* slab_vec.h: whether blurs lie in a slab, for vectors. */
#ifndef RF_SLAB_VEC_H
#define RF_SLAB_VEC_H

#include "simd/vec.h"
#include "tiles/slab.h"

/* 0 <= s - low <= width as one signed comparison, s - from < to, in all lanes. */
struct rf_limits {
    vec_u16 from, to;
};

/* Adding 2^15 to both sides makes an unsigned comparison of a signed one. */
static inline void rf_set_limits(struct rf_limits *limits, const struct rf_slab *slab,
                                 int slabs)
{
    for (int k = 0; k < slabs; k++) {
        limits[k].from = vec_u16_set((uint16_t)(slab[k].low ^ 0x8000));
        limits[k].to = vec_u16_set((uint16_t)((slab[k].width + 1) ^ 0x8000));
    }
}

/* Those of `among` that lie in it. */
static inline vec_mask rf_in_limits(vec_mask among, const struct rf_limits *limits,
                                    vec_u16 blur)
{
    return vec_mask_less(among, vec_u16_sub(blur, limits->from), limits->to);
}

#endif
