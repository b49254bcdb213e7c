/* pull.c: inpaints the unknown pixels of a pyramid level from the coarser one. */
#include "kernels/kernels.h"
#include "kernels/pull_mix.h"

void rf_pull_c(uint16_t *out, const int16_t *out_blur, const struct rf_parents *parents,
               struct rf_mixed_parents mixed, int pairs)
{
    const int16_t apart = parents->apart;
    uint16_t *const light = mixed.light + 1; /* light[-1] and light[pairs] repeat the ends */
    int16_t *const blur = mixed.blur + 1;

    for (int x = 0; x < pairs; x++) {
        const struct rf_two_blurs two = {parents->near_blur[x], parents->far_blur[x]};

        light[x] = rf_mix_light(parents->near_light[x], parents->far_light[x], two, apart);
        blur[x] = rf_mix_blur(two, apart);
    }
    light[-1] = light[0];
    light[pairs] = light[pairs - 1];
    blur[-1] = blur[0];
    blur[pairs] = blur[pairs - 1];
    for (int i = 0; i < 2 * pairs; i++) {
        const int near = i / 2, far = near + (i % 2 ? 1 : -1);

        if (out_blur[i] == RF_NO_BLUR)
            out[i] = rf_mix_light(light[near], light[far],
                                  (struct rf_two_blurs){blur[near], blur[far]}, apart);
    }
}
