/* pull_blur_vec.c: gives the unknown pixels of a pyramid level the blur of their parents, a vector
 * of parents at a time. */
#include "kernels/kernels.h"
#include "kernels/pull_mix_vec.h"
#include "kernels/pyramid_vec.h"
#include "simd/vec.h"

static inline void mix_rows(int16_t *blur, const struct rf_parents *parents, int pairs)
{
    const vec_u16 apart = vec_u16_set((uint16_t)parents->apart);
    int x = 0;

    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16)
        vec_u16_store(blur + x, rf_mix_blur_vec(vec_u16_load(parents->near_blur + x),
                                                vec_u16_load(parents->far_blur + x), apart));
    for (; x < pairs; x++)
        blur[x] = rf_mix_blur((struct rf_two_blurs){parents->near_blur[x], parents->far_blur[x]},
                              parents->apart);
    blur[-1] = blur[0];
    blur[pairs] = blur[pairs - 1];
}

void RF_VEC(rf_pull_blur)(int16_t *out, const struct rf_parents *parents, int16_t *mixed, int pairs)
{
    const vec_u16 apart = vec_u16_set((uint16_t)parents->apart);
    const vec_u16 inpainted = vec_u16_set(RF_INPAINTED);
    int16_t *const blur = mixed + 1; /* blur[-1] and blur[pairs] repeat the ends */
    int x = 0;

    mix_rows(blur, parents, pairs);
    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16) {
        const vec_u16 left = rf_unknown(vec_u16_load(out + 2 * x));
        const vec_u16 right = rf_unknown(vec_u16_load(out + 2 * x + (int)VEC_U16));
        vec_u16 near, even, odd;

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        near = vec_u16_load(blur + x);
        even = vec_u16_or(rf_mix_blur_vec(near, vec_u16_load(blur + x - 1), apart), inpainted);
        odd = vec_u16_or(rf_mix_blur_vec(near, vec_u16_load(blur + x + 1), apart), inpainted);
        rf_put_where(out + 2 * x, left, vec_u16_zip_low(even, odd));
        rf_put_where(out + 2 * x + (int)VEC_U16, right, vec_u16_zip_high(even, odd));
    }
    for (int i = 2 * x; i < 2 * pairs; i++) {
        const int near = i / 2, far = near + (i % 2 ? 1 : -1);

        if (out[i] == RF_NO_BLUR)
            out[i] =
                rf_inpainted_blur((struct rf_two_blurs){blur[near], blur[far]}, parents->apart);
    }
}
