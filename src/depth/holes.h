/* holes.h: gives samples of a depth map without a value that of the surface around them. */
#ifndef RF_DEPTH_HOLES_H
#define RF_DEPTH_HOLES_H

#include <stddef.h>
#include <stdint.h>

#include "depth/hole_colours.h"

/*
 * Inpaints the unknown disparities from the known ones around them.
 *
 * An unknown sample p takes the disparity of the known sample q with the least
 *
 *     |p - q| + w (d(q) + 3 |c(p) - c(q)|)
 *
 * with w an eighth of the larger side, at least 16 samples, over paths through unknown samples: the
 * nearest one on a continuous surface, whose d changes by less than 1/w a sample, and the farther
 * of two surfaces that meet, up to w times their difference away. c is what the photo shows, in the
 * channel that differs most, 0 to 1; without a photo it is 0. A surface whose colour is nearer to
 * that of p by 85 codes is taken as if it were w samples nearer: so a hole within a thing that
 * stands out from what is behind it is the thing's, and of two that look the same the farther one
 * has it.
 *
 * For outer samples, those left of the first known sample of their row or right of the last one, w
 * is a quarter: the hole has no other side there, and surfaces mostly go on to the border of the
 * map. Not so a thing that is no wider than the hole at the border is there, and nearer than what
 * is behind it by half of the range, as a pole beside the unmeasured columns at the left of a
 * Kinect's map: the hole is next to what is behind it.
 * In a sparse map, as of a laser scanner, of three rows and columns or more, most of whose known
 * samples have less than half of their eight neighbours, p is no farther from one than two mean
 * distances of samples, but in a hole; up to there |p - q| counts alone, and nothing at the border
 * is a thing. What is inpainted is then smoothed where it is continuous, the wider the deeper it
 * lies in a hole.
 *
 * Time is linear in the number of samples. At least one sample is known.
 *
 * stride: bytes from a row of the disparities to the next
 * state:  width x height, RF_SAMPLE_KNOWN or RF_SAMPLE_UNKNOWN; holds the distances to q
 *         in half samples afterwards, 254 at most. With a photo RF_HOLE_COLOUR_BYTES a sample
 *         follow, to work in
 * photo:  packed, of the same view and of any size; or NULL
 */
void rf_fill_holes(uint16_t *disparity, ptrdiff_t stride, int width, int height, uint8_t *state,
                   const struct refocus_image *photo);

#endif
