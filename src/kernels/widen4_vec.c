/* widen4_vec.c: the depth upsampler: computes each pixel of a row as a weighted mean of four
 * samples, four pixels at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

void RF_VEC(rf_widen4)(uint16_t *out, const uint16_t *in, const struct rf_taps *taps, int n)
{
    int x = 0;

    for (; x + 4 <= n; x += 4) {
        const struct rf_taps *at = taps + x;
        const uint16_t *const d[4] = {in + at[0].first, in + at[1].first, in + at[2].first,
                                      in + at[3].first};
        const int16_t *const share[4] = {at[0].share, at[1].share, at[2].share, at[3].share};

        vec_dots4(out + x, d, share);
    }
    rf_widen4_c(out + x, in, taps + x, n - x);
}
