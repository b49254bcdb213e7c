/* smooth_vec.c: the pre-filter, three planes at once. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { PIXEL = 256, TWO_PIXELS = 511 };

/* Which neighbours count, in all lanes, and what follows from it. */
struct use {
    vec_u16 before, after, neither;
    vec_u16 bias;   /* rounding: 1, and 2 for a mean of two */
    vec_u16 factor; /* see mean() */
};

/* |s| / 8, from one pixel to two; of s and -s the lesser is |s|, which is below 2^15. */
static inline vec_u16 tolerance(vec_u16 s)
{
    const vec_u16 own = vec_u16_min(s, vec_u16_sub(vec_u16_set(0), s));

    return vec_u16_min(vec_u16_max(vec_u16_half(vec_u16_half(vec_u16_half(own))),
                                   vec_u16_set(PIXEL)),
                       vec_u16_set(TWO_PIXELS));
}

static inline vec_u16 within(vec_u16 a, vec_u16 b, vec_u16 tolerance)
{
    return vec_u16_at_most(vec_u16_add(vec_u16_sub(a, b), tolerance),
                           vec_u16_add(tolerance, tolerance));
}

static inline struct use use_of(const int16_t *blur, ptrdiff_t apart, vec_u16 least)
{
    const vec_u16 s = vec_u16_load(blur), t = tolerance(s);
    /* |s| <= least; s + least stays below 2^16 + s, and |s| <= 32512 */
    const vec_u16 narrow = vec_u16_at_most(vec_u16_add(s, least), vec_u16_add(least, least));
    const vec_u16 before =
        vec_u16_without(within(vec_u16_load(blur - apart), s, t), narrow);
    const vec_u16 after =
        vec_u16_without(within(vec_u16_load(blur + apart), s, t), narrow);
    const vec_u16 three = vec_u16_and(before, after);

    return (struct use){
        .before = before,
        .after = after,
        .neither = vec_u16_without(vec_u16_set(0xffff), vec_u16_or(before, after)),
        .bias = vec_u16_sub(vec_u16_set(1), vec_u16_xor(before, after)),
        .factor = vec_u16_sub(vec_u16_set(65535), vec_u16_and(three, vec_u16_set(21844))),
    };
}

/* A third of x is (x 43691) >> 17; (x 65535) >> 16 is x - 1, which halves the sum of two plus 2,
 * or of a pixel and itself plus 1, to the mean half up. */
static inline vec_u16 mean(const uint16_t *light, ptrdiff_t apart, const struct use *use)
{
    const vec_u16 own = vec_u16_load(light);
    vec_u16 sum = vec_u16_add(own, vec_u16_and(own, use->neither));

    sum = vec_u16_add(sum, vec_u16_and(vec_u16_load(light - apart), use->before));
    sum = vec_u16_add(sum, vec_u16_and(vec_u16_load(light + apart), use->after));
    return vec_u16_half(vec_u16_mul_high(vec_u16_add(sum, use->bias), use->factor));
}

static void RF_VEC(rf_smooth3)(uint16_t *const out[3], const uint16_t *const light[3],
                               const int16_t *blur, ptrdiff_t apart, int least, int n)
{
    uint16_t *const red = out[0], *const green = out[1], *const blue = out[2];
    const uint16_t *const r = light[0], *const g = light[1], *const b = light[2];
    const vec_u16 from = vec_u16_set((uint16_t)least);

    if (n < (int)VEC_U16) {
        rf_smooth3_c(out, light, blur, apart, least, n);
        return;
    }
    for (int x = 0; x < n; x += VEC_U16) {
        const int at = x + (int)VEC_U16 <= n ? x : n - (int)VEC_U16; /* some twice */
        const struct use use = use_of(blur + at, apart, from);

        vec_u16_store(red + at, mean(r + at, apart, &use));
        vec_u16_store(green + at, mean(g + at, apart, &use));
        vec_u16_store(blue + at, mean(b + at, apart, &use));
    }
}

static void RF_VEC(rf_smooth1)(uint16_t *out, const uint16_t *light, const int16_t *blur,
                               ptrdiff_t apart, int least, int n)
{
    const vec_u16 from = vec_u16_set((uint16_t)least);

    if (n < (int)VEC_U16) {
        rf_smooth1_c(out, light, blur, apart, least, n);
        return;
    }
    for (int x = 0; x < n; x += VEC_U16) {
        const int at = x + (int)VEC_U16 <= n ? x : n - (int)VEC_U16; /* some twice */
        const struct use use = use_of(blur + at, apart, from);

        vec_u16_store(out + at, mean(light + at, apart, &use));
    }
}

void RF_VEC(rf_smooth_use)(struct rf_kernels *kernels)
{
    kernels->smooth1 = RF_VEC(rf_smooth1);
    kernels->smooth3 = RF_VEC(rf_smooth3);
}
