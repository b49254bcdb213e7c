/* holes.h: gives samples of a depth map without a value that of the surface around them. */
#ifndef RF_DEPTH_HOLES_H
#define RF_DEPTH_HOLES_H

#include <stddef.h>
#include <stdint.h>

/* The state of a sample when rf_fill_holes() begins. */
enum { RF_SAMPLE_KNOWN = 0, RF_SAMPLE_UNKNOWN = 255 };

/*
 * Inpaints the unknown disparities from the known ones around them.
 *
 * An unknown sample p takes the disparity of the known sample q with the least
 *
 *     |p - q| + w d(q),    w = an eighth of the larger side, at least 16 samples
 *
 * over paths through unknown samples: the nearest one on a continuous surface, whose d
 * changes by less than 1/w a sample, and the farther of two surfaces that meet, up to w
 * times their difference away. For outer samples, those left of the first known sample of their
 * row or right of the last one, w is a quarter: the hole has no other side there, and surfaces
 * mostly go on to the border of the map. Not so a thing that is no wider than the hole at the
 * border is there, and nearer than what is behind it by half of the range, as a pole beside the
 * unmeasured columns at the left of a Kinect's map: the hole is next to what is behind it.
 * In a sparse map, as of a laser scanner, of three rows and columns or more, most of whose known
 * samples have less than half of their eight neighbours, p is no farther from one than two mean
 * distances of samples, but in a hole: there w d(q) does not count, and nothing at the border is a
 * thing. What is inpainted is then smoothed where it is continuous, the wider the deeper it lies in
 * a hole.
 *
 * Time is linear in the number of samples. At least one sample is known.
 *
 * stride: bytes from a row of the disparities to the next
 * state:  width x height, RF_SAMPLE_KNOWN or RF_SAMPLE_UNKNOWN; holds the distances to q
 *         in half samples afterwards, 254 at most
 */
void rf_fill_holes(uint16_t *disparity, ptrdiff_t stride, int width, int height, uint8_t *state);

#endif
