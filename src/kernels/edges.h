/* edges.h: contracts of the loops that put the edges of a disparity map in their place. */
#ifndef RF_KERNELS_EDGES_H
#define RF_KERNELS_EDGES_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

/*
 * steepest: for n pixels of row[1], which of the eight neighbours is the greatest and which the
 * least, as 16 least + greatest; of equal ones the first in this order:
 *
 *     7 3 5
 *     1   0
 *     6 2 4
 *
 * RF_NO_DIRECTION where no neighbour is greater, or less, than the pixel. Elements -1 to n of each
 * row are read.
 */
enum { RF_NO_DIRECTION = 8 };
typedef void rf_steepest_fn(uint8_t *out, const uint16_t *const row[3], int n);

/*
 * Windows around a pixel: rows 0, step, 2 step ... of columns 0 to columns - 1. They are a multiple
 * of RF_VOTE_COLUMNS, so that vectors are full: where less is wanted, nearness is 0.
 */
enum {
    RF_VOTE_COLUMNS = 16,
    RF_MOST_VOTE_ROWS = 32,
    RF_MOST_VOTE_COLUMNS = 32,
};

/*
 * tally: how much those around a pixel that look like it are near, and how much far: sums of
 *
 *     weight = nearness 255 (1 - (difference / 73)^2)^8 / 32
 *     difference = |R - r| + |G - g| + |B - b|
 *
 * (a Gaussian, nearly, of 18 codes) over the pixels of a window whose disparity is from `least`,
 * not 0, to `most`; above `middle` they are near. *_value are sums of weight x (disparity - least)
 * / 32, all rounded down. A voter of 0 does not vote.
 */
struct rf_vote_window {
    const uint8_t *colour[3]; /* the window's first pixel, as in `voter` */
    const uint16_t *voter;    /* disparity, at least 1; 0: none */
    ptrdiff_t stride;         /* elements of the planes above */
    const uint8_t *nearness;  /* rows of the window that are looked at */
    ptrdiff_t nearness_stride;
    int columns, rows, step;
    uint8_t own[3]; /* the pixel's colour */
    uint16_t least, middle, most;
};
struct rf_votes {
    uint32_t near, far, near_value, far_value;
};
static_assert((uint64_t)RF_MOST_VOTE_ROWS * RF_MOST_VOTE_COLUMNS * (255 * 255 / 32) *
                      (65535 / 32) <=
                  UINT32_MAX,
              "sums of values fit 32 bits");
typedef struct rf_votes rf_tally_fn(const struct rf_vote_window *window);

/*
 * core_sums: of the pixels of a window whose nearness is not 0 and whose disparity is from `least`,
 * not 0, to `most`: how many there are, the sum of their nearness, and that of nearness times
 * disparity.
 */
struct rf_core_window {
    const uint16_t *core; /* disparity, at least 1; 0: none */
    ptrdiff_t stride;
    const uint8_t *nearness;
    ptrdiff_t nearness_stride;
    int columns, rows, step;
    uint16_t least, most;
};
struct rf_core_sums {
    uint64_t value;
    uint32_t weight, count;
};
static_assert((uint64_t)RF_MOST_VOTE_ROWS * 255 * 65535 <= UINT32_MAX, "a column fits 32 bits");
typedef struct rf_core_sums rf_core_sums_fn(const struct rf_core_window *window);

/*
 * surface_sums: the weights of the pixels of a window (step 1) that differ by less than `most` from
 * `surface`, those of all, and the sum of weight times disparity over the others. Weights add up to
 * at most 2^16, so that every sum fits 32 bits.
 */
struct rf_surface_window {
    const uint16_t *label; /* disparity */
    ptrdiff_t stride;
    const uint16_t *weight; /* Q16 */
    ptrdiff_t weight_stride;
    int columns, rows;
    uint16_t surface, most;
};
struct rf_surface_sums {
    uint32_t own, all, other;
};
typedef struct rf_surface_sums rf_surface_sums_fn(const struct rf_surface_window *window);

#endif
