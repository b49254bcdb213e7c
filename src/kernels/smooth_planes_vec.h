/* smooth_planes_vec.h: the template of the pre-filter's steps, a vector of pixels at a time. */
#ifndef RF_KERNELS_SMOOTH_PLANES_VEC_H
#define RF_KERNELS_SMOOTH_PLANES_VEC_H

#include "kernels/kernels.h"
#include "simd/vec.h"

enum { RF_PIXEL = 256, RF_TWO_PIXELS = 511 };

/* The neighbours that do not count, and rf_smooth_share(). */
struct rf_smooth_use {
    vec_u16 not_before, not_after, share;
};

/* The blur from which on the mean comes in, and how it fades in. */
struct rf_smooth_fade {
    vec_u16 least, over, unit;
};

static inline struct rf_smooth_fade rf_smooth_fade(int least, int over)
{
    return (struct rf_smooth_fade){vec_u16_set((uint16_t)least), vec_u16_set((uint16_t)over),
                                   vec_u16_set((uint16_t)(65535 / over))};
}

/* |s| / 8, from one pixel to two. */
static inline vec_u16 rf_smooth_tolerance(vec_u16 size)
{
    return vec_u16_min(
        vec_u16_max(vec_u16_half(vec_u16_half(vec_u16_half(size))), vec_u16_set(RF_PIXEL)),
        vec_u16_set(RF_TWO_PIXELS));
}

static inline struct rf_smooth_use rf_smooth_use(const int16_t *blur, ptrdiff_t apart,
                                                 const struct rf_smooth_fade *fade)
{
    const vec_u16 s = vec_u16_load(blur);
    /* The lesser of s and -s as unsigned numbers is |s|, which is below 2^15. */
    const vec_u16 size = vec_u16_min(s, vec_u16_sub(vec_u16_set(0), s)),
                  t = rf_smooth_tolerance(size);
    const vec_u16 above = vec_u16_sub(vec_u16_max(size, fade->least), fade->least);
    const vec_u16 in = vec_u16_mul(vec_u16_min(above, fade->over), fade->unit);

    return (struct rf_smooth_use){
        .not_before = vec_s16_less(t, vec_s16_apart(vec_u16_load(blur - apart), s)),
        .not_after = vec_s16_less(t, vec_s16_apart(vec_u16_load(blur + apart), s)),
        .share = vec_u16_mul_high(in, vec_u16_set(RF_SMOOTH_THIRD)),
    };
}

/* A pixel differs from both its neighbours by at most 2 * 4 * 4095 in sum, so that signed lanes
 * hold it. */
static inline vec_u16 rf_smooth_mean(const uint16_t *light, ptrdiff_t apart,
                                     const struct rf_smooth_use *use)
{
    const vec_u16 own = vec_u16_load(light);
    const vec_u16 before = vec_u16_sub(own, vec_u16_load(light - apart));
    const vec_u16 after = vec_u16_sub(own, vec_u16_load(light + apart));
    const vec_u16 more = vec_u16_add(vec_u16_without(before, use->not_before),
                                     vec_u16_without(after, use->not_after));

    return vec_u16_sub(own, vec_s16_scale(more, use->share));
}

/* n pixels, at least a vector of them. */
static RF_ALWAYS_INLINE void rf_smooth_planes_vec(uint16_t *const *out,
                                                  const uint16_t *const *light, const int16_t *blur,
                                                  ptrdiff_t apart, int least, int over, int n,
                                                  const int planes)
{
    const struct rf_smooth_fade fade = rf_smooth_fade(least, over);
    const uint16_t *from[3];
    uint16_t *to[3];

    for (int c = 0; c < planes; c++) {
        from[c] = light[c];
        to[c] = out[c];
    }
    for (int x = 0; x < n; x += (int)VEC_U16) {
        const int at = x + (int)VEC_U16 <= n ? x : n - (int)VEC_U16; /* some twice */
        const struct rf_smooth_use use = rf_smooth_use(blur + at, apart, &fade);

        for (int c = 0; c < planes; c++)
            vec_u16_store(to[c] + at, rf_smooth_mean(from[c] + at, apart, &use));
    }
}

#endif
