/* pull_vec.c: inpaints the unknown pixels of a pyramid level from the coarser one, a vector of
 * parents at a time. */
#include "kernels/kernels.h"
#include "kernels/pull_mix_vec.h"
#include "kernels/pyramid_vec.h"
#include "simd/vec.h"

static inline void mix_rows(uint16_t *light, int16_t *blur, const struct rf_parents *parents,
                            int pairs)
{
    const vec_u16 apart = vec_u16_set((uint16_t)parents->apart);
    int x = 0;

    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16) {
        const vec_u16 near = vec_u16_load(parents->near_blur + x);
        const vec_u16 far = vec_u16_load(parents->far_blur + x);

        vec_u16_store(light + x,
                      rf_mix_light_vec(vec_u16_load(parents->near_light + x),
                                       vec_u16_load(parents->far_light + x), near, far, apart));
        vec_u16_store(blur + x, rf_mix_blur_vec(near, far, apart));
    }
    for (; x < pairs; x++) {
        const struct rf_two_blurs two = {parents->near_blur[x], parents->far_blur[x]};

        light[x] = rf_mix_light(parents->near_light[x], parents->far_light[x], two, parents->apart);
        blur[x] = rf_mix_blur(two, parents->apart);
    }
    light[-1] = light[0];
    light[pairs] = light[pairs - 1];
    blur[-1] = blur[0];
    blur[pairs] = blur[pairs - 1];
}

void RF_VEC(rf_pull)(uint16_t *out, const int16_t *out_blur, const struct rf_parents *parents,
                     struct rf_mixed_parents mixed, int pairs)
{
    const vec_u16 apart = vec_u16_set((uint16_t)parents->apart);
    uint16_t *const light = mixed.light + 1; /* light[-1] and light[pairs] repeat the ends */
    int16_t *const blur = mixed.blur + 1;
    int x = 0;

    mix_rows(light, blur, parents, pairs);
    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16) {
        const vec_u16 left = rf_unknown(vec_u16_load(out_blur + 2 * x));
        const vec_u16 right = rf_unknown(vec_u16_load(out_blur + 2 * x + (int)VEC_U16));
        vec_u16 near, depth, even, odd;

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        near = vec_u16_load(light + x);
        depth = vec_u16_load(blur + x);
        even = rf_mix_light_vec(near, vec_u16_load(light + x - 1), depth,
                                vec_u16_load(blur + x - 1), apart);
        odd = rf_mix_light_vec(near, vec_u16_load(light + x + 1), depth, vec_u16_load(blur + x + 1),
                               apart);
        rf_put_where(out + 2 * x, left, vec_u16_zip_low(even, odd));
        rf_put_where(out + 2 * x + (int)VEC_U16, right, vec_u16_zip_high(even, odd));
    }
    for (int i = 2 * x; i < 2 * pairs; i++) {
        const int near = i / 2, far = near + (i % 2 ? 1 : -1);

        if (out_blur[i] == RF_NO_BLUR)
            out[i] = rf_mix_light(light[near], light[far],
                                  (struct rf_two_blurs){blur[near], blur[far]}, parents->apart);
    }
}
