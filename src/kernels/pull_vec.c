/* pull_vec.c: inpaints the unknown pixels of a pyramid level from the coarser one, a vector of
 * parents at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"
#include "kernels/pyramid_vec.h"

static inline vec_u16 quarters(vec_u16 three, vec_u16 one)
{
    const vec_u16 sum = vec_u16_add(vec_u16_add(three, three), vec_u16_add(three, one));

    return vec_u16_half(vec_u16_half(vec_u16_add(sum, vec_u16_set(2))));
}

static inline uint16_t quarters_of(unsigned three, unsigned one)
{
    return (uint16_t)((3 * three + one + 2) >> 2);
}

void RF_VEC(rf_pull)(uint16_t *out, const int16_t *out_blur, const uint16_t *near_row,
                     const uint16_t *far_row, uint16_t *mixed, int pairs)
{
    int x = 0;

    mixed++; /* mixed[-1] and mixed[pairs] repeat the ends */
    for (; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16)
        vec_u16_store(mixed + x, quarters(vec_u16_load(near_row + x), vec_u16_load(far_row + x)));
    for (; x < pairs; x++)
        mixed[x] = quarters_of(near_row[x], far_row[x]);
    mixed[-1] = mixed[0];
    mixed[pairs] = mixed[pairs - 1];
    for (x = 0; x + (int)VEC_U16 <= pairs; x += (int)VEC_U16) {
        const vec_u16 left = rf_unknown(vec_u16_load(out_blur + 2 * x));
        const vec_u16 right = rf_unknown(vec_u16_load(out_blur + 2 * x + (int)VEC_U16));
        vec_u16 middle, even, odd;

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        middle = vec_u16_load(mixed + x);
        even = quarters(middle, vec_u16_load(mixed + x - 1));
        odd = quarters(middle, vec_u16_load(mixed + x + 1));
        rf_put_where(out + 2 * x, left, vec_u16_zip_low(even, odd));
        rf_put_where(out + 2 * x + (int)VEC_U16, right, vec_u16_zip_high(even, odd));
    }
    for (; x < pairs; x++) {
        if (out_blur[2 * x] == RF_NO_BLUR)
            out[2 * x] = quarters_of(mixed[x], mixed[x - 1]);
        if (out_blur[2 * x + 1] == RF_NO_BLUR)
            out[2 * x + 1] = quarters_of(mixed[x], mixed[x + 1]);
    }
}
