/* weights.h: the highlight weights of Yang et al. 2016, eq. 5, for the pixels that rays hit. */
#ifndef RF_WEIGHTS_H
#define RF_WEIGHTS_H

#include "image/planes.h"
#include "image/viewport.h"

struct rf_weights {
    const uint16_t *light_weight;           /* read: the weight of each Q12 light, Q15 */
    struct rf_light_q12 smooth, background; /* read */
    bool is_luminance; /* light is luminance, in channel[0] alone, and `weight` has its stride */
    struct rf_weight_q15 weight;            /* written, borders too: of `smooth`, */
    bool has_background;                    /* `background_weight` is written, too */
    struct rf_weight_q15 background_weight; /* weights of `background` */
};

/* Writes the weights of a row of tiles. */
void rf_weigh_rows(const struct rf_viewport *view, const struct rf_weights *pass, int ty);

#endif
