/* restore_known2.c: restores the samples of chroma that are known and not to be inpainted. */
#include "kernels/kernels.h"

void RF_VEC(rf_restore_known2)(uint16_t *restrict out, const uint16_t *restrict own,
                               const int16_t *restrict background_blur, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t known = (uint16_t) - ((background_blur[2 * x] != RF_NO_BLUR) &
                                             (background_blur[2 * x + 1] != RF_NO_BLUR));

        out[2 * x] = (uint16_t)((own[2 * x] & known) | (out[2 * x] & ~known));
        out[2 * x + 1] = (uint16_t)((own[2 * x + 1] & known) | (out[2 * x + 1] & ~known));
    }
}
