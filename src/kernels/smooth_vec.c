/* smooth_vec.c: the pre-filter, three planes at once. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { PIXEL = 256, TWO_PIXELS = 511 };

/* Which neighbours count, in all lanes, and what follows from it. */
struct use {
    vec_u16 before, after, neither;
    vec_u16 bias;   /* rounding: 1, and 2 for a mean of two */
    vec_u16 factor; /* see mean() */
    vec_u16 left;   /* rf_fade_left(), */
    bool fades;     /* which is not 0 everywhere */
};

/* From which blur on, and how the mean comes in. */
struct fade {
    vec_u16 least, over, factor;
    vec_u16 most; /* blur that it is not wholly there at */
};

static inline struct fade fade_of(int least, int over)
{
    const int whole = least + over;

    return (struct fade){vec_u16_set((uint16_t)least), vec_u16_set((uint16_t)over),
                         vec_u16_set((uint16_t)(65535 / over)),
                         vec_u16_set((uint16_t)(whole < 65536 ? whole - 1 : 65535))};
}

/* |s| / 8, from one pixel to two. */
static inline vec_u16 tolerance(vec_u16 size)
{
    return vec_u16_min(vec_u16_max(vec_u16_half(vec_u16_half(vec_u16_half(size))),
                                   vec_u16_set(PIXEL)),
                       vec_u16_set(TWO_PIXELS));
}

static inline vec_u16 within(vec_u16 a, vec_u16 b, vec_u16 tolerance)
{
    return vec_u16_at_most(vec_u16_add(vec_u16_sub(a, b), tolerance),
                           vec_u16_add(tolerance, tolerance));
}

static inline struct use use_of(const int16_t *blur, ptrdiff_t apart, const struct fade *fade)
{
    const vec_u16 s = vec_u16_load(blur);
    /* of s and -s the lesser is |s|, which is below 2^15 */
    const vec_u16 size = vec_u16_min(s, vec_u16_sub(vec_u16_set(0), s)), t = tolerance(size);
    vec_u16 before = within(vec_u16_load(blur - apart), s, t);
    vec_u16 after = within(vec_u16_load(blur + apart), s, t), left = vec_u16_set(0);
    bool fades = false;

    if (vec_u16_any(vec_u16_at_most(size, fade->most))) {
        const vec_u16 narrow = vec_u16_at_most(size, fade->least);
        const vec_u16 above = vec_u16_sub(vec_u16_max(size, fade->least), fade->least);

        left = vec_u16_sub(fade->over, vec_u16_min(above, fade->over));
        before = vec_u16_without(before, narrow);
        after = vec_u16_without(after, narrow);
        fades = vec_u16_any(vec_u16_without(left, narrow));
    }
    const vec_u16 three = vec_u16_and(before, after);

    return (struct use){
        .before = before,
        .after = after,
        .neither = vec_u16_without(vec_u16_set(0xffff), vec_u16_or(before, after)),
        .bias = vec_u16_sub(vec_u16_set(1), vec_u16_xor(before, after)),
        .factor = vec_u16_sub(vec_u16_set(65535), vec_u16_and(three, vec_u16_set(21844))),
        .left = vec_u16_mul(left, fade->factor),
        .fades = fades,
    };
}

/* A third of x is (x 43691) >> 17; (x 65535) >> 16 is x - 1, which halves the sum of two plus 2,
 * or of a pixel and itself plus 1, to the mean half up. */
static inline vec_u16 mean(const uint16_t *light, ptrdiff_t apart, const struct use *use)
{
    const vec_u16 own = vec_u16_load(light);
    vec_u16 sum = vec_u16_add(own, vec_u16_and(own, use->neither)), all, most;

    sum = vec_u16_add(sum, vec_u16_and(vec_u16_load(light - apart), use->before));
    sum = vec_u16_add(sum, vec_u16_and(vec_u16_load(light + apart), use->after));
    all = vec_u16_half(vec_u16_mul_high(vec_u16_add(sum, use->bias), use->factor));
    if (!use->fades)
        return all;
    most = vec_u16_max(all, own);
    return vec_u16_add(vec_u16_sub(all, vec_u16_mul_high(vec_u16_sub(most, own), use->left)),
                       vec_u16_mul_high(vec_u16_sub(most, all), use->left));
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
