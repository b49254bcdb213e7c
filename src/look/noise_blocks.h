/* noise_blocks.h: how much the pixels of the blocks of a photo differ. */
#ifndef RF_NOISE_BLOCKS_H
#define RF_NOISE_BLOCKS_H

#include "look/look.h"

enum {
    RF_NOISE_ROUGH = 256, /* a block of texture counts as this in `rough` of struct rf_grain */
    RF_NOISE_OCTAVE = 64, /* bins of an octave of variance, and the unit of `bend` */
};

/* Counts the blocks of look->photo into `blocks`, `near`, `rough` and `bend` of look->grain. */
void rf_count_noise_blocks(const struct rf_look *look);

/* The middle of a bin of struct rf_grain, in code^2. */
double rf_noise_bin_middle(int bin);

#endif
