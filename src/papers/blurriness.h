/* blurriness.h: the table of the NVIDIA white paper that turns disparities into blur. */
#ifndef RF_BLURRINESS_H
#define RF_BLURRINESS_H

#include <stdint.h>

enum { RF_BLURRINESS_SIZE = 1024 }; /* a 1D texture of 1 KB */

/*
 * The "blurriness interpolator" by disparity, d = i / 1023, in 1/255:
 *
 *     0 up to a circle of confusion of c0, 1/2 at r1 c0, 1 from r2 c0 on, linear between.
 *
 * The paper's circle, |(F/D - 1) f^2 / (N (F - f))| for a camera distance D and the focus
 * distance F, is linear in 1/D; with the disparity d, also linear in 1/D, it is K |d - df|.
 *
 * @middle, last: r1 c0 and r2 c0 in pixels of radius, c0 < middle < last
 */
void rf_blurriness_table(uint8_t table[RF_BLURRINESS_SIZE], double focus, double blur, double c0,
                         double middle, double last);

#endif
