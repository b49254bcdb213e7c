/* bayer.h: thresholds of ordered dither (Bayer 1973). */
#ifndef RF_BAYER_H
#define RF_BAYER_H

/* The threshold at a pixel, 0 to 4^bits - 1: each once in 2^bits x 2^bits pixels. */
static inline int rf_bayer(int x, int y, int bits)
{
    int threshold = 0;

    for (int bit = 0; bit < bits; bit++)
        threshold = 4 * threshold + 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1);
    return threshold;
}

#endif
