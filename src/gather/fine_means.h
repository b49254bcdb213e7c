/* fine_means.h: what means of Q14 leave over, for pictures of more than 8 bits. */
#ifndef RF_FINE_MEANS_H
#define RF_FINE_MEANS_H

#include "gather/frame.h"
#include "gather/tile_rows.h"

/* A tile and the fine part of its means: `more` is to be added to `mean`, in 1/256 of Q14. */
struct rf_fine_means {
    int16_t more[3][RF_TILE * RF_TILE];
    uint16_t mean[3][RF_TILE * RF_TILE];
};

/* How a tile's means are made of sums. */
struct rf_mean_steps {
    struct rf_tile_rows rows;
    uint16_t softness;
    uint32_t rays;
};

/* Computes what the means of channel c leave over, of the sums of Q12 that they are made of. */
void rf_fine_means(struct rf_fine_means *fine, int c, const struct rf_kernels *kernels,
                   const struct rf_mean_steps *steps, const uint32_t *sum, const uint16_t *mean);

/* Forgets it where means have changed since, as something was drawn over them. */
void rf_fine_means_forget(struct rf_fine_means *fine, uint16_t mean[3][RF_TILE * RF_TILE]);

#endif
