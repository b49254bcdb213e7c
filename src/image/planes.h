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

#include <refocus/params.h>

/* Linear light of R, G and B, Q12: RF_LIGHT_MAX is white. Padded. */
struct rf_light_q12 {
    uint16_t *channel[3];
    ptrdiff_t stride;
};

/* The brightest channel of the pixel that lies at `at` of its planes. */
static inline int rf_brightest_at(const struct rf_light_q12 *light, ptrdiff_t at)
{
    int most = light->channel[0][at];

    most = light->channel[1][at] > most ? light->channel[1][at] : most;
    return light->channel[2][at] > most ? light->channel[2][at] : most;
}

/*
 * Signed radius of the circle of confusion s = K (df - d), Q7.8 of 2^unit pixels: negative before
 * the focus. Padded. The unit, 0 to RF_MAX_UNIT, goes by the K of the frame: 0 up to 127 pixels.
 * Above, blurs are at most RF_UNIT_RADIUS units, so that two of them differ by less than 2^16 less
 * the widest slab (tiles/tiles.c).
 */
enum { RF_MAX_UNIT = 3, RF_PLAIN_RADIUS = REFOCUS_PLAIN_BLUR_RADIUS, RF_UNIT_RADIUS = 118 };
struct rf_blur_q8 {
    int16_t *at;
    ptrdiff_t stride;
    int unit;
};

/* The unit of a frame's blurs, K in pixels. */
static inline int rf_unit_of(float max_blur_radius)
{
    int unit = 0;

    if (max_blur_radius > RF_PLAIN_RADIUS)
        for (unit = 1; max_blur_radius > (float)(RF_UNIT_RADIUS << unit);)
            unit++;
    return unit;
}

/* A blur of a plane in 1/256 pixel, and such a one, which is kept within the range of a plane, as
 * it is stored. */
static inline int rf_in_pixels(int blur, int unit)
{
    return blur * (1 << unit);
}

static inline int16_t rf_in_units(int blur, int unit)
{
    const int v = blur >> unit;

    return (int16_t)(v < INT16_MAX ? v : INT16_MAX);
}

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
