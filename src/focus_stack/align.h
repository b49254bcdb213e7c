/* align.h: one step of the alignment of two frames of a focus stack. */
#ifndef RF_ALIGN_H
#define RF_ALIGN_H

#include <stdbool.h>
#include <stdint.h>

enum { RF_ALIGN_UNKNOWNS = 7 }; /* e, f, gain, bias, and of apertures how the gain falls off */

/* A level of two pictures; c is about its middle. */
struct rf_align_level {
    const uint16_t *reference, *frame;
    int16_t *warped; /* -1: outside of the frame */
    int width, height;
    int unknowns;
};

struct rf_align_sums {
    int64_t left[RF_ALIGN_UNKNOWNS][RF_ALIGN_UNKNOWNS], right[RF_ALIGN_UNKNOWNS];
    int64_t residual, pixels;
};

/* Sums over all pixels, whose residuals are clamped. */
void rf_align_add_up(struct rf_align_sums *sums, const struct rf_align_level *level, int clamp);
/* The step that they ask for, of the first n unknowns; false: the pictures do not say. */
bool rf_align_solve(const struct rf_align_sums *sums, int n, double out[RF_ALIGN_UNKNOWNS]);

#endif
