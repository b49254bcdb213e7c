/* transfer.h: converts between 8-bit codes and the values that are averaged.
 *
 * Values are Q12: 0 to RF_LIGHT_MAX = 4095 is black to white. Means are Q14: four times
 * that, so that an average keeps two bits that its parts do not have.
 */
#ifndef RF_TRANSFER_H
#define RF_TRANSFER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    RF_LIGHT_MAX = 4095,
    RF_MEAN_MAX = 4 * RF_LIGHT_MAX,
    RF_WEIGHT_MAX = 32767, /* the largest weight of eq. 5, Q15 */
    RF_BLEND_COUNT = 3,    /* enum refocus_blend */
};

#define RF_NO_BLEND UINT32_MAX /* none of enum refocus_blend */

struct rf_transfer {
    uint16_t to_light[256];           /* Q12 */
    uint8_t to_code[RF_MEAN_MAX + 4]; /* code of a Q14 mean */
};

/* The Q12 value of each of 256 codes. */
const uint16_t *rf_light_of_codes(uint32_t blend);

void rf_transfer_init(struct rf_transfer *transfer, int blend);

/* Sets the weight of each Q12 light max(R, G, B) with that sigma. */
void rf_weights_of_light(uint16_t light_weight[RF_LIGHT_MAX + 1],
                         const struct rf_transfer *transfer, double sigma);

#endif
