/* pull_blur.c: gives the unknown pixels of a pyramid level the blur of their parents. */
#include "kernels/kernels.h"
#include "kernels/pull_mix.h"

void rf_pull_blur_c(int16_t *out, const struct rf_parents *parents, int16_t *mixed, int pairs)
{
    const int16_t apart = parents->apart;
    int16_t *const blur = mixed + 1; /* blur[-1] and blur[pairs] repeat the ends */

    for (int x = 0; x < pairs; x++)
        blur[x] =
            rf_mix_blur((struct rf_two_blurs){parents->near_blur[x], parents->far_blur[x]}, apart);
    blur[-1] = blur[0];
    blur[pairs] = blur[pairs - 1];
    for (int i = 0; i < 2 * pairs; i++) {
        const int near = i / 2, far = near + (i % 2 ? 1 : -1);

        if (out[i] == RF_NO_BLUR)
            out[i] = rf_inpainted_blur((struct rf_two_blurs){blur[near], blur[far]}, apart);
    }
}
