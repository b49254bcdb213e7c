/* smooth.h: smooths a disparity map up to its edges, by means of pixels that lie apart.
 *
 * Each pass takes a binomial 3x3 mean with neighbours some pixels apart, of those that differ by no
 * more than `alike` from the pixel (the a trous algorithm, Holschneider et al. 1989). Passes with
 * different distances reach far for few operations. In the end no pixel is moved by more than
 * `most_moved`.
 */
#ifndef RF_SMOOTH_H
#define RF_SMOOTH_H

#include <stdint.h>

#include "image/planes.h"
#include "kernels/kernels.h"
#include "support/pool.h"

enum { RF_SMOOTH_APART = 8 }; /* no neighbours are farther apart */

struct rf_smooth_pass {
    int apart;      /* pixels, 1 to RF_SMOOTH_APART */
    uint16_t alike; /* at most RF_MOST_SMOOTHED */
};

/* The codes of a map, which are replaced, and two planes of its size to work in. */
struct rf_smoother {
    const struct rf_kernels *kernels;
    struct rf_disparity_q16 code, spare[2];
    int width, height;
    const struct rf_smooth_pass *pass;
    int passes; /* 1 or more */
    uint16_t most_moved;
};

/* Smooths the codes in place. pool: NULL for the calling thread alone. */
void rf_smooth(const struct rf_smoother *s, struct rf_pool *pool);

#endif
