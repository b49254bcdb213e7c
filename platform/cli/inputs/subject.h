/* subject.h: the subject of a photo, by its depth alone. */
#ifndef RF_CLI_SUBJECT_H
#define RF_CLI_SUBJECT_H

#include <stdbool.h>
#include <stdint.h>

/*
 * Finds the disparity of what stands before its surroundings, where the centre of the photo does
 * not show it: a person beside the middle. disparity: packed rows of the photo's size; `centre`:
 * that of the surface at the centre. Returns false where the centre is as good a choice: no surface
 * stands out much more, or it is on both sides of the picture, like the walls of an alley.
 *
 * Each of 64 x 64 samples has the weight
 *
 *     (1 - r^2) (max(d - m, 0) + 1/32)
 *
 * where r is the distance from the centre, 1 in the corners, d the disparity and m the median of
 * its row: the ground is as near as its row. The subject is the range of 1/12 of the disparities
 * with the greatest sum of weights, if it is nearer than the centre's own range and has three times
 * the weight of that. An example: a person of disparity 0.8 beside the centre, before a wall of
 * 0.1, covers a fifth of the samples, the wall the others: with equal distances from the centre 0.2
 * (0.7 + 0.03) is more than three times 0.8 x 0.03.
 */
bool input_find_subject(const uint16_t *disparity, int width, int height, double centre,
                        double *subject);

#endif
