/* yuv.h: contracts of the kernels between codes of Y, U and V and luma and chroma. */
#ifndef RF_KERNELS_YUV_H
#define RF_KERNELS_YUV_H

#include <stddef.h>
#include <stdint.h>

#include "colour/yuv.h"
#include "kernels/slab.h"

/*
 * encode: codes of n samples of chroma and of the 2 or 4 pixels that share each to chroma, D_b
 * and D_r of rf_chroma_of() side by side, and luminance. Rows are 2 n long; where there is one
 * row, luma[1] is luma[0] and out[1] is out[0].
 */
typedef void rf_encode_fn(uint16_t *const out[2], uint16_t *chroma, const uint8_t *const luma[2],
                          const uint8_t *uv, const struct rf_yuv_curve *curve, int n);

/*
 * guide: R, G and B of n pixels, a byte each, tones in quarters, half up. Codes of U and V are
 * pairs for two pixels: R' = Y' + rf_more() and so on, as colour/yuv.h says.
 */
typedef void rf_guide_fn(uint8_t *rgb, const uint8_t *luma, const uint8_t *uv,
                         const struct rf_yuv_curve *curve, int n);

/*
 * decode: means of a tile of luma and chroma to codes, rf_chroma_code() of each sample and
 *
 *     Y = to_code[L - E] of its pixels
 *
 * with L' the mean of the luminances of the pixels that share a sample: of 2 x 2 if `down`, of
 * 2 x 1 else. Means above white are white. Pixels whose luminance and chroma are 4 times
 * `own` keep their codes; samples all of whose pixels do, too.
 */
struct rf_decode_job {
    const struct rf_yuv_curve *curve;
    int down;
    uint16_t luma[RF_TILE * RF_TILE], chroma[RF_TILE * RF_TILE]; /* rows of RF_TILE, Q14 */
    const uint16_t *own_luma, *own_chroma;               /* Q12, of the tile's first element */
    ptrdiff_t stride;                                    /* stride of both planes */
    uint8_t y[RF_TILE * RF_TILE], uv[RF_TILE * RF_TILE]; /* in: codes that were; out */
};
typedef void rf_decode_fn(struct rf_decode_job *job);

#endif
