/* planes.h: typed views of the planes of a window: where pixel (0, 0) lies, and the stride.
 *
 * Pixel (x, y) of a view is at[y * stride + x]. The type names the fixed-point format, so that a
 * plane cannot be passed as something that it is not. A view owns nothing: planes are laid out, and
 * given to passes, by renderer/layout.c and renderer/window.c. In padded planes x and y may be
 * negative, and exceed the window, by as much as window.pad.
 */
#ifndef RF_PLANES_H
#define RF_PLANES_H

#include <stddef.h>
#include <stdint.h>

/* Linear light of R, G and B, Q12: RF_LIGHT_MAX is white. Padded. */
struct rf_light_q12 {
    uint16_t *channel[3];
    ptrdiff_t stride;
};

/* Signed radius of the circle of confusion s = K (df - d) in pixels, Q7.8: negative before the
 * focus. Padded. */
struct rf_blur_q8 {
    int16_t *at;
    ptrdiff_t stride;
};

/* Disparity, Q16: 65535 is nearest. Padded, without a border. */
struct rf_disparity_q16 {
    uint16_t *at;
    ptrdiff_t stride;
};

/* Highlight weight of eq. 5, Q15. Padded. */
struct rf_weight_q15 {
    uint16_t *at;
    ptrdiff_t stride;
};

/* Alpha of the photo, 255 where it is opaque. */
struct rf_alpha_u8 {
    uint8_t *at;
    ptrdiff_t stride;
};

/* The hidden background: what a blurred foreground uncovers, with a circle of confusion of its
 * own. */
struct rf_background {
    struct rf_light_q12 light;
    struct rf_blur_q8 blur;
};

#endif
