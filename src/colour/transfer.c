/* transfer.c: makes the tables between 8-bit codes and the values that are averaged. */
#include "colour/transfer.h"

#include "support/exp_minus.h"

#include <refocus/render.h>

#include <string.h>

#include "tables/transfer.inc"

const uint16_t *rf_light_of_codes(uint32_t blend)
{
    return blend == REFOCUS_BLEND_STORED  ? stored_to_light
           : blend == REFOCUS_BLEND_GAMMA ? gamma_to_light
                                          : srgb_to_light;
}

void rf_transfer_init(struct rf_transfer *transfer, int blend)
{
    const uint16_t *const light = rf_light_of_codes((uint32_t)blend);
    const uint16_t *const boundary = blend == REFOCUS_BLEND_STORED  ? stored_boundary
                                     : blend == REFOCUS_BLEND_GAMMA ? gamma_boundary
                                                                    : srgb_boundary;
    size_t mean = 0;

    for (int code = 0; code < 256; code++) {
        const size_t next = code < 255 ? boundary[code] : sizeof transfer->to_code;

        transfer->to_light[code] = light[code];
        memset(transfer->to_code + mean, code, next - mean);
        mean = next;
    }
}

/*
 * Highlight weights of Yang et al. 2016, eq. 5, in Q15 of the largest:
 *
 *     w[c] = exp(-(c - 255)^2 / 2 sigma^2),  c = max(R, G, B)
 *
 * at least 1/32767, so that no average is ever empty.
 */
static void highlight_weights(uint16_t weight[256], double sigma)
{
    for (int c = 0; c < 256; c++) {
        const double below = (255 - c) / sigma;
        const double w = RF_WEIGHT_MAX * rf_exp_minus(below * below / 2) + 0.5;

        weight[c] = w < 1 ? 1 : (uint16_t)w;
    }
}

void rf_weights_of_light(uint16_t light_weight[RF_LIGHT_MAX + 1],
                         const struct rf_transfer *transfer, double sigma)
{
    uint16_t weight[256];

    highlight_weights(weight, sigma);
    for (int light = 0; light <= RF_LIGHT_MAX; light++)
        light_weight[light] = weight[transfer->to_code[4 * light]];
}
