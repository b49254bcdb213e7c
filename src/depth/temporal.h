/* temporal.h: frames and motion that the files of the temporal filter share. */
#ifndef RF_TEMPORAL_H
#define RF_TEMPORAL_H

#include <stdbool.h>
#include <stdint.h>

enum { RF_BLOCK = 8, RF_MOST_MOTION = 16 /* samples a frame */ };

struct rf_motion {
    int8_t x, y; /* from here to where it was */
};

/* A frame: disparities, and 8 bits of what the photo shows there. */
struct rf_frame {
    uint16_t *disparity;
    uint8_t *guide;
};

/*
 * Where each block of `now` was in `last`: the best of the vectors of its neighbours, of its own
 * in the last frame and of none, and what is better step by step from there.
 * motion: a vector a block, those of the last frame before
 */
void rf_find_motion(struct rf_motion *motion, const struct rf_frame *now,
                    const struct rf_frame *last, int width, int height);

#endif
