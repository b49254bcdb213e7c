/* impulses.h: impulse noise of a disparity map, samples that are far off those around them.
 *
 * Light fields and stereo without a check leave such samples, which are blurred by far more or less
 * than the surface that they lie on: each shows as a speck. rf_noise_of() does not see them, as
 * most samples have none of it.
 *
 * A sample is alone that is more than 0.1 off each of its eight neighbours. Exact maps of six
 * scenes have at most 0.04 % of these; that of a light field has 1.7 %. From 0.4 % on, each sample
 * that is more than 0.03 off the median of 5 x 5 takes that. A map of fewer samples than the photo
 * has is left alone: of wires it holds single samples that are true.
 */
#ifndef RF_IMPULSES_H
#define RF_IMPULSES_H

#include "image/planes.h"
#include "support/pool.h"

/* The share of samples that are alone, in 1/65536: 0 if there are too few. Of a large map some rows
 * are looked at. */
int rf_impulses_of(struct rf_disparity_q16 map, int width, int height);

/* Puts samples right in place; the spare plane is of the map's size. */
void rf_remove_impulses(struct rf_disparity_q16 map, struct rf_disparity_q16 spare, int width,
                        int height, struct rf_pool *pool);

#endif
