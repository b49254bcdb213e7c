/* metrics.h: scores of how far a picture is from a reference. All pictures are 8-bit sRGB, R G B
 * packed, without padding between rows. */
#ifndef QUALITY_METRICS_H
#define QUALITY_METRICS_H

#include <stdint.h>

struct quality_scores {
    double psnr;      /* dB over the R, G and B of the pixels that count */
    double rmse;      /* root of the mean squared error, in codes of 0..255 */
    double ssim;      /* on luma; NAN when no 11x11 window fits */
    double edge_psnr; /* dB over the pixels of the edge mask; NAN when there are none */
    long pixels;      /* pixels that count: all but a border */
    long edge_pixels; /* number of these in the edge mask */
};

/* Root mean square difference over R, G and B of the pixels at least @border from
 * each side and, when @mask is given, not 0 there. NAN when no pixel counts. */
double quality_rmse(const uint8_t *a, const uint8_t *b, int width, int height, int border,
                    const uint8_t *mask, long *pixels);

/* 20 log10(255 / rmse); INFINITY for equal pictures. */
double quality_psnr(double rmse);

/* Structural similarity, Wang et al. 2004: Gaussian window of 11x11, sigma 1.5,
 * C1 = (0.01 255)^2, C2 = (0.03 255)^2, on luma 0.299 R + 0.587 G + 0.114 B of the
 * stored values; mean over the windows that lie in the picture and whose centre is
 * at least @border from each side. Returns 0, or -1 without memory. */
int quality_ssim(const uint8_t *a, const uint8_t *b, int width, int height, int border,
                 double *ssim);

/* Marks the pixels near depth edges. A jump is between two 4-neighbours whose
 * disparities differ by 2 pixels of blur or more: K |d1 - d2| >= 2. The pixels within
 * max(K |d1 - df|, K |d2 - df|) of either of the two are the edge band: where the
 * blur of one surface can meet the other. Returns 0, or -1 without memory. */
int quality_edge_mask(const uint16_t *disparity, int width, int height, double focus, double blur,
                      uint8_t *mask);

/* Compute all scores; @mask may be NULL. Returns 0, or -1 without memory. */
int quality_score(const uint8_t *picture, const uint8_t *reference, int width, int height,
                  int border, const uint8_t *mask, struct quality_scores *scores);

#endif
