/* weights.h: the highlight weights of Yang et al. 2016, eq. 5, for the pixels that rays hit. */
#ifndef RF_WEIGHTS_H
#define RF_WEIGHTS_H

#include "image/chroma.h"

#include <assert.h>
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"
#include "tiles/bins.h"

/* Chroma of a photo of Y, U and V, which has the weight of the first pixel of a sample. */
struct rf_weights_chroma {
    struct rf_chroma_size size;
    struct rf_chroma_q12 smooth, background; /* times the weight afterwards, if premultiplied */
};

struct rf_weights {
    const uint16_t *light_weight; /* read: the weight of each Q12 light, Q15 */
    struct rf_light_q12 smooth,
        background;              /* read; times the weight afterwards, if premultiplied */
    struct rf_weight_q15 weight; /* written, borders too: of `smooth`, */
    bool has_background;         /* else only those */
    struct rf_weight_q15 background_weight; /* weights of `background` */
    struct rf_bins *bins; /* written, if premultiplied: the brightest of each tile */
    const struct rf_weights_chroma *chroma; /* NULL: a photo of R, G and B; else light is luminance,
                                               in channel[0] alone, and `weight` has its stride */
};

/* Writes the weights of a row of tiles. */
void rf_weigh_rows(const struct rf_viewport *view, const struct rf_weights *pass, int ty);

/* Writes them in Q12, and multiplies the light by them, as kernels.h, weigh and weigh1, has it. */
void rf_premultiply_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                         const struct rf_weights *pass, int ty, int worker);

/*
 * How far the mean of luminance, or of chroma, that is the same everywhere may be from 4 times that
 * when both layers are premultiplied: 1/2 of Q13 times Q12, or of Q12 times Q12, by the least
 * weight, and 1/2. Of weights of RF_YUV_LEAST_WEIGHT / 4096 and more it is at most 15.
 */
enum { RF_YUV_LEAST_WEIGHT = 586 };
static_assert(1 + (4096 << 1) / RF_YUV_LEAST_WEIGHT <= 15, "what kernels->decode takes");
static inline uint16_t rf_yuv_within(const uint16_t *light_weight, int chroma)
{
    return (uint16_t)(1 + (4096 << chroma) / (light_weight[0] >> 3));
}

#endif
