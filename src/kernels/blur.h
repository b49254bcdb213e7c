/* blur.h: contracts of the kernels of blur radii, and of the pre-filter that goes by them. */
#ifndef RF_KERNELS_BLUR_H
#define RF_KERNELS_BLUR_H

#include <assert.h>
#include "colour/transfer.h"
#include <stddef.h>
#include <stdint.h>

/* Focus and blur in fixed point. */
struct rf_focus {
    uint16_t disparity; /* df, Q16 with 65535 = 1 */
    uint16_t radius;    /* K in Q8.8 of 2^unit pixels, scaled by 65536 / 65535 */
    uint16_t unit;      /* unit of the blurs: image/planes.h */
};

/*
 * signed_blur: s = K (df - d), Yang et al. 2016, eq. 4. Q7.8 of 2^unit pixels, rounded half up in
 * magnitude: within 1/512 pixel for this focus, within 1.25/256 of that of real K and df.
 */
static_assert((uint64_t)UINT16_MAX * (127 * 256 + 1) + (1 << 15) <= UINT32_MAX,
              "the product and its rounding fit 32 bits");
typedef void rf_signed_blur_fn(int16_t *blur, const uint16_t *disparity, struct rf_focus focus,
                               int n);

/*
 * smooth3, of three planes: a third of the way from a pixel to each of its two neighbours, `apart`
 * elements before and after, whose blur is within an eighth of its own, but at least one pixel
 * (256) and less than two (511), of it. That is the mean of three of a kind. It begins where
 * |blur| > least and comes in over the next `over` of blur, 1 at least. Light is at most 4 * 4095
 * here and below, so that the way to both fits 16 bits. The rows written are not among those read.
 *
 * rf_smooth_share(): of the way to both, Q15, half up.
 */
enum { RF_SMOOTH_THIRD = 10923 };
static_assert(2 * 4 * RF_LIGHT_MAX <= INT16_MAX, "the way to both neighbours fits 16 bits");
static inline int rf_smooth_share(int blur, int least, int over)
{
    const int above = (blur < 0 ? -blur : blur) - least;
    const int in = above < 0 ? 0 : above < over ? above : over;

    return in * (65535 / over) * RF_SMOOTH_THIRD >> 16;
}
typedef void rf_smooth3_fn(uint16_t *const out[3], const uint16_t *const light[3],
                           const int16_t *blur, ptrdiff_t apart, int least, int over, int n);

/* smooth1: smooth3, of one plane. */
typedef void rf_smooth1_fn(uint16_t *out, const uint16_t *light, const int16_t *blur,
                           ptrdiff_t apart, int least, int over, int n);

/* sharpest4: of 2 x 2 blurs the first with the least |s|, twice: n pairs out of rows of 2 n.
 * Blurs are at most 127 pixels. */
typedef void rf_sharpest4_fn(int16_t *out, const int16_t *upper, const int16_t *lower, int n);

#endif
