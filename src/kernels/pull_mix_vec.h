/* pull_mix_vec.h: what two parents of the inpainting pyramid make together, in vectors. */
#ifndef RF_KERNELS_PULL_MIX_VEC_H
#define RF_KERNELS_PULL_MIX_VEC_H

#include "kernels/pull_mix.h"
#include "simd/vec.h"

/* rf_mix_light() and rf_mix_blur() of a vector of parents. The difference is capped at INT16_MAX,
 * which is not more than itself. */
static inline vec_u16 rf_mix_light_vec(vec_u16 near, vec_u16 far, vec_u16 near_blur,
                                       vec_u16 far_blur, vec_u16 apart)
{
    const vec_u16 differ = vec_s16_less(apart, vec_s16_apart(near_blur, far_blur));
    const vec_u16 is_farther = vec_s16_less(far_blur, near_blur); /* the near one */
    const vec_u16 other = vec_u16_select(is_farther, far_blur, near_blur);
    const vec_u16 is_known =
        vec_u16_at_most(vec_u16_and(other, vec_u16_set(RF_INPAINTED)), vec_u16_set(0));
    const vec_u16 sum = vec_u16_add(vec_u16_add(near, near), vec_u16_add(near, far));
    const vec_u16 mean = vec_u16_half(vec_u16_half(vec_u16_add(sum, vec_u16_set(2))));
    const vec_u16 farther = vec_u16_select(is_farther, near, far);

    return vec_u16_select(vec_u16_and(differ, is_known), farther, mean);
}

static inline vec_u16 rf_mix_blur_vec(vec_u16 near_blur, vec_u16 far_blur, vec_u16 apart)
{
    const vec_u16 differ = vec_s16_less(apart, vec_s16_apart(near_blur, far_blur));

    return vec_u16_select(differ, vec_s16_max(near_blur, far_blur), near_blur);
}

#endif
