/* target.h: the blurred pictures of the NVIDIA white paper, smaller the more they are blurred. */
#ifndef RF_TARGET_H
#define RF_TARGET_H

#include "papers/papers.h"

/* A picture of 1 / 2^shift the size, blurred: light in Q14. */
struct rf_target {
    int shift, width, height;
    int16_t *light[3];
};

enum {
    RF_TARGET_SHIFTS = 4,
    RF_TARGET_TAPS = 12, /* at most so many to either side */
    RF_TARGET_SPARE = 64,
    RF_TARGET_ROWS = 5,     /* rows of floats, scratch of a thread */
    RF_TARGET_CHANNELS = 4, /* light times weight in R, G, B, and the weight of eq. 5 */
};

struct rf_target_work {
    const struct rf_frame *f;
    float *across[RF_TARGET_CHANNELS]; /* filtered in x, as large as the picture */
    float *row;                        /* scratch of each thread */
    int row_length;                    /* the picture's width and RF_TARGET_SPARE */
    const struct rf_target *target;
    float tap[RF_TARGET_TAPS + 1]; /* the filter from its middle on */
    int taps;
};

static inline float *rf_target_scratch(const struct rf_target_work *work, int worker)
{
    return work->row + (size_t)worker * (size_t)work->row_length * RF_TARGET_ROWS;
}

/* Sets size and light for a blur radius in pixels that is cut at REFOCUS_PLAIN_BLUR_RADIUS. */
void rf_target_make(struct rf_target_work *work, struct rf_target *target, double radius);

#endif
