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

/* Whether all means from `low` to `high` have the code c. */
static bool is_code(const struct rf_transfer *transfer, int c, double low, double high)
{
    return low >= 0 && high < RF_MEAN_MAX + 4 && transfer->to_code[(int)low] == c &&
           transfer->to_code[(int)high] == c;
}

/* Whether code c comes back from its light, with the weight of any pixel whose largest code is c or
 * more. */
static bool keeps_code(const struct rf_transfer *transfer, const uint16_t weight[256], int c)
{
    for (int most = c; most < 256; most++) {
        const int w = weight[most] >> 3;
        const double mean = 8192.0 * ((2 * transfer->to_light[c] * w + 2048) >> 12) / w + 0.5;

        if (!is_code(transfer, c, mean - 0.02, mean + 0.02)) /* means of rays are that close */
            return false;
    }
    return true;
}

/*
 * Whether each code comes back from its weighted mean, although light times weight in 16 bits
 * (kernels.h, weigh) is rounded. It must do so with the weight of any pixel none of whose
 * channels is below it. In sRGB it does for weights of 0.64 and more of the largest, from
 * sigma 272 on.
 */
static bool keep_codes(const struct rf_transfer *transfer, const uint16_t weight[256])
{
    for (int c = 0; c < 256; c++)
        if (weight[c] < 8 || !keeps_code(transfer, weight, c))
            return false;
    return true;
}

bool rf_weights_of_light(uint16_t light_weight[RF_LIGHT_MAX + 1],
                         const struct rf_transfer *transfer, double sigma)
{
    uint16_t weight[256];

    highlight_weights(weight, sigma);
    for (int light = 0; light <= RF_LIGHT_MAX; light++)
        light_weight[light] = weight[transfer->to_code[4 * light]];
    return keep_codes(transfer, weight);
}
