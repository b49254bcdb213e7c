/* light_pyramid.h: the levels of a pyramid of means, each of half the width and height of the one
 * before. */
#ifndef RF_LIGHT_PYRAMID_H
#define RF_LIGHT_PYRAMID_H

enum { RF_PYRAMID_SIDE = 512 };

/* Means of 2 x 2 of a level make the next one; what is beyond the last row or column is like it. */
void rf_pyramid_halve(const float *fine, int width, int height, float *out);

/* Adds to a level of this width and height a part of the next one, which is read between its means
 * in proportion. */
void rf_pyramid_add_doubled(const float *next, float part, int width, int height, float *fine);

/* Smooths a level by 1 2 1 in rows and columns; its sides repeat. At most RF_PYRAMID_SIDE across.
 */
void rf_pyramid_smooth(float *at, int width, int height);

#endif
