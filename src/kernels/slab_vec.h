/* slab_vec.h: the test whether blurs lie in a slab, in vectors. */
#ifndef RF_SLAB_VEC_H
#define RF_SLAB_VEC_H

#include "kernels/rays.h"
#include "simd/vec.h"
#include "kernels/slab.h"

struct rf_limits {
    vec_u16 from, to; /* rf_in_range() */
};

/* The limits of test t of ray n. */
static inline struct rf_limits rf_limits_of(const struct rf_sorted_rays *rays, int t, int n)
{
    return (struct rf_limits){vec_u16_set(rays->from[t][n]), vec_u16_set(rays->to[t][n])};
}

/* The lanes of `among` whose blur lies in the range. */
static inline vec_mask rf_in_limits(vec_mask among, struct rf_limits limits, vec_u16 blur)
{
    return vec_mask_less(among, vec_u16_sub(blur, limits.from), limits.to);
}

#endif
