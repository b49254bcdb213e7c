/* ximgproc.h: what the module of OpenCV's contrib filters gives to
 * librefocus-opencv. */
#ifndef RF_XIMGPROC_H
#define RF_XIMGPROC_H

#include <stdint.h>

/* All planes are packed; rgb is 8 bits. Each returns 0 or -1, and lets no exception
 * out. */
struct rf_ximgproc {
    uint32_t version; /* RF_XIMGPROC_VERSION */
    /* depth: in and out, of the size of rgb, 0 to 1. filter: enum refocus_cv_filter. */
    int (*smooth)(uint32_t filter, const uint8_t *rgb, float *depth, int width, int height,
                  int reach);
    /* Disparities of left from left and right, in pixels, NaN where there is none; wls:
     * out. */
    int (*wls)(const uint8_t *rgb, const float *left, const float *right, float *out, int width,
               int height);
};
enum { RF_XIMGPROC_VERSION = 1 };

#endif
