/* noise.h: the noise of a disparity map is measured, and smoothed away within surfaces.
 *
 * A surface with noise of 2 % is blurred by all that the noise says, of which some pixels are hit
 * by rays and others not, and it takes a slab for each blur (src/tiles). It is measured by how far
 * a pixel lies from the line through its neighbours, |2 d - d' - d''|, across or down, whichever is
 * less: on surfaces and along edges that is noise alone. A quarter of all pixels are below 0.38 of
 * its standard deviation (0.26 to 0.43 in maps of four scenes with 0.5 to 5 % of it).
 *
 * A map without noise has none: the quarter lies at 0 in exact maps and most of those of 8 bits.
 * On a slope that is askew the codes of 8 bits lie off their line nearly everywhere, but by one
 * step at most. So there is noise in a map of few codes only if a quarter of its pixels are off by
 * more.
 */
#ifndef RF_NOISE_H
#define RF_NOISE_H

#include "depth/smooth.h"

/* The standard deviation of the noise of a map, Q16: 0 if there is too little to be seen. Of a
 * large map some rows are looked at. step: rf_code_step() of the map. */
int rf_noise_of(struct rf_disparity_q16 map, int width, int height, int step);

/* Smooths noise of a standard deviation away, in place; spare planes are of the map's size. */
void rf_denoise(const struct rf_kernels *kernels, struct rf_disparity_q16 map,
                const struct rf_disparity_q16 spare[2], int width, int height, int deviation,
                struct rf_pool *pool);

#endif
