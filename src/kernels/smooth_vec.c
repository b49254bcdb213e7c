/* smooth_vec.c: the pre-filter, three planes at once. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { PIXEL = 256, TWO_PIXELS = 511 };

/* Which neighbours do not count, and rf_smooth_share(). */
struct use {
    vec_u16 not_before, not_after, share;
};

/* From which blur on, and how the neighbours come in. */
struct fade {
    vec_u16 least, over, unit;
};

static inline struct fade fade_of(int least, int over)
{
    return (struct fade){vec_u16_set((uint16_t)least), vec_u16_set((uint16_t)over),
                         vec_u16_set((uint16_t)(65535 / over))};
}

/* |s| / 8, from one pixel to two. */
static inline vec_u16 tolerance(vec_u16 size)
{
    return vec_u16_min(
        vec_u16_max(vec_u16_half(vec_u16_half(vec_u16_half(size))), vec_u16_set(PIXEL)),
        vec_u16_set(TWO_PIXELS));
}

static inline struct use use_of(const int16_t *blur, ptrdiff_t apart, const struct fade *fade)
{
    const vec_u16 s = vec_u16_load(blur);
    /* of s and -s the lesser is |s|, which is below 2^15 */
    const vec_u16 size = vec_u16_min(s, vec_u16_sub(vec_u16_set(0), s)), t = tolerance(size);
    const vec_u16 above = vec_u16_sub(vec_u16_max(size, fade->least), fade->least);
    const vec_u16 in = vec_u16_mul(vec_u16_min(above, fade->over), fade->unit);

    return (struct use){
        .not_before = vec_s16_less(t, vec_s16_apart(vec_u16_load(blur - apart), s)),
        .not_after = vec_s16_less(t, vec_s16_apart(vec_u16_load(blur + apart), s)),
        .share = vec_u16_mul_high(in, vec_u16_set(RF_SMOOTH_THIRD)),
    };
}

/* What a pixel has more than its neighbours is at most 2 * 4 * 4095: the share is of signed
 * lanes. */
static inline vec_u16 mean(const uint16_t *light, ptrdiff_t apart, const struct use *use)
{
    const vec_u16 own = vec_u16_load(light);
    const vec_u16 before = vec_u16_sub(own, vec_u16_load(light - apart));
    const vec_u16 after = vec_u16_sub(own, vec_u16_load(light + apart));
    const vec_u16 more = vec_u16_add(vec_u16_without(before, use->not_before),
                                     vec_u16_without(after, use->not_after));

    return vec_u16_sub(own, vec_s16_scale(more, use->share));
}

static void RF_VEC(rf_smooth3)(uint16_t *const out[3], const uint16_t *const light[3],
                               const int16_t *blur, ptrdiff_t apart, int least, int over, int n)
{
    uint16_t *const red = out[0], *const green = out[1], *const blue = out[2];
    const uint16_t *const r = light[0], *const g = light[1], *const b = light[2];
    const struct fade fade = fade_of(least, over);

    if (n < (int)VEC_U16) {
        rf_smooth3_c(out, light, blur, apart, least, over, n);
        return;
    }
    for (int x = 0; x < n; x += VEC_U16) {
        const int at = x + (int)VEC_U16 <= n ? x : n - (int)VEC_U16; /* some twice */
        const struct use use = use_of(blur + at, apart, &fade);

        vec_u16_store(red + at, mean(r + at, apart, &use));
        vec_u16_store(green + at, mean(g + at, apart, &use));
        vec_u16_store(blue + at, mean(b + at, apart, &use));
    }
}

static void RF_VEC(rf_smooth1)(uint16_t *out, const uint16_t *light, const int16_t *blur,
                               ptrdiff_t apart, int least, int over, int n)
{
    const struct fade fade = fade_of(least, over);

    if (n < (int)VEC_U16) {
        rf_smooth1_c(out, light, blur, apart, least, over, n);
        return;
    }
    for (int x = 0; x < n; x += VEC_U16) {
        const int at = x + (int)VEC_U16 <= n ? x : n - (int)VEC_U16; /* some twice */
        const struct use use = use_of(blur + at, apart, &fade);

        vec_u16_store(out + at, mean(light + at, apart, &use));
    }
}

void RF_VEC(rf_smooth_use)(struct rf_kernels *kernels)
{
    kernels->smooth1 = RF_VEC(rf_smooth1);
    kernels->smooth3 = RF_VEC(rf_smooth3);
}
