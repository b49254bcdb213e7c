/* dequantise.h: makes slopes of the steps in a disparity map that has few codes.
 *
 * A map of 8 bits shows a slope as a staircase: at K = 105 pixels each step is 0.41 pixels of
 * blur, more than two neighbouring slabs of the sweep overlap (src/tiles), and rays slip between
 * them and hit the surface that they occlude. So a map whose codes are that far apart is smoothed
 * over steps of one code and nowhere else, and no pixel leaves the interval that was rounded to its
 * code: half a step up and down. Edges between surfaces are more than a step and stay as they are.
 *
 * The smoothing (depth/smooth.h) has neighbours 4, 2 and 1 pixels apart, so a pixel depends on
 * those up to RF_DEQUANTISE_REACH away. Then a step of 257 codes is spread over 14 pixels: what is
 * left between two neighbours is 0.08 pixels of blur at K = 127.
 */
#ifndef RF_DEQUANTISE_H
#define RF_DEQUANTISE_H

#include <refocus/image.h>

#include "image/planes.h"
#include "kernels/kernels.h"
#include "support/pool.h"

enum { RF_DEQUANTISE_REACH = 4 + 2 + 1 };

/*
 * How far the codes of a map are apart, in 1/65535, or 0 if it is to be left as it is: it has so
 * many codes that their steps cannot be seen, so few that they are as likely drawn as measured,
 * or they lie so far apart that a step is an edge. In maps from networks and colour tables codes
 * are unevenly apart, so nine of ten steps are not more than this.
 */
int rf_code_step(const struct refocus_disparity *map);

/* The codes of a map, which are replaced, and two planes of its size to work in. */
struct rf_dequantiser {
    const struct rf_kernels *kernels;
    struct rf_disparity_q16 code, spare[2];
    int width, height;
    int step; /* rf_code_step(), not 0 */
};

/* Smooths the codes in place. pool: NULL for the calling thread alone. */
void rf_dequantise(const struct rf_dequantiser *d, struct rf_pool *pool);

/* Smooths a few pixels of a map whose others are not wanted: `width` x `height` from (x, y) on, at
 * most RF_DEQUANTISE_PATCH each, to rows of that width. step == 0: they stay as the map has them.
 */
enum { RF_DEQUANTISE_PATCH = 8 };
void rf_dequantised_patch(const struct rf_kernels *kernels, const struct refocus_disparity *map,
                          int step, int x, int y, int width, int height, uint16_t *out);

#endif
