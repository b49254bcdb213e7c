/* thin_plain.h: the plain reference of find_thin. */
#ifndef KERNELS_THIN_PLAIN_H
#define KERNELS_THIN_PLAIN_H

#include "kernels/kernels.h"

/* A photo; row y begins at [y * stride]. */
struct photo {
    int width, height;
    ptrdiff_t stride;
    const uint16_t *disparity, *light[3];
    const uint16_t *most3; /* the greatest disparity of 3 x 3 pixels */
};

/* All of a tile; returns how many. */
int find_thin_plain(struct rf_thin *out, const struct photo *p, int tx, int ty);

#endif
