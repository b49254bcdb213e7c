/* planes.h: the passes that turn a photo and a lens setting into planes.
 *
 * Each works on rows y0 <= y < y1 and may run for several bands of rows at once.
 */
#ifndef RF_PLANES_H
#define RF_PLANES_H

#include "renderer/renderer.h"

/* Photo rows to light planes and alpha. */
void rf_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo, int y0,
                     int y1);

/* Change light planes from the blend they are in to another. */
void rf_reblend_rows(struct refocus_renderer *r, uint32_t blend, int y0, int y1);

/* Disparities of the photo's size, copied. */
void rf_disparity_rows(struct refocus_renderer *r, const struct refocus_disparity *map,
                       int y0, int y1);

/* Focus and blur in fixed point. */
struct rf_focus {
    uint16_t disparity; /* df, Q16 with 65535 = 1 */
    uint16_t radius;    /* K in Q8.8, scaled by 65536 / 65535 */
};
struct rf_focus rf_focus_of(float focus_disparity, float max_blur_radius);

/*
 * Signed blur: s = K (df - d), Yang et al. 2016, eq. 4. Q7.8 pixels, rounded half up in
 * magnitude; within 1/256 pixel of the real value. The border is extended.
 */
void rf_signed_blur_rows(struct refocus_renderer *r, struct rf_focus focus, int y0, int y1);

/*
 * Pre-filter: where |s| is above `least` (Q7.8), the mean of those pixels of the 3x3
 * neighbourhood that are within one pixel of blur of its middle; the light as it is
 * elsewhere. Rays of a set of N meet the picture |s| sqrt(pi / N) pixels apart.
 */
void rf_prefilter_rows(struct refocus_renderer *r, int least, int y0, int y1);

/* Extend rows y0..y1-1 of a padded plane of 16-bit values beyond its sides, and the first
 * and the last row of the picture above and below it. */
void rf_extend_rows(const struct refocus_renderer *r, void *plane, int y0, int y1);

#endif
