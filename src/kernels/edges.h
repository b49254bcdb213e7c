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
 * tally: how much those around a pixel that look like it are near, and how much far: sums of
 *
 *     weight = nearness (1 - (difference / 73)^2)^8 / 32,   difference = |R - r| + |G - g| + |B -
 * b|
 *
 * (a Gaussian, nearly, of 18 codes) over the pixels of a window whose disparity is from `least` to
 * `most`; above `middle` they are near. *_value are sums of weight x (disparity - least) / 32, all
 * rounded down. A window has rows 0, step, 2 step ... of columns 0 to columns - 1; a voter of 0
 * does not vote. At most RF_MOST_VOTERS: then all sums fit 32 bits.
 */
enum { RF_MOST_VOTERS = 578 };
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
static_assert((uint64_t)RF_MOST_VOTERS * (255 * 255 / 32) * (65535 / 32) <= UINT32_MAX,
              "sums of values fit 32 bits");
typedef struct rf_votes rf_tally_fn(const struct rf_vote_window *window);

/*
 * core_sums: of the pixels of a window whose disparity is from `least`, which is not 0, to `most`:
 * how many there are, the sum of their nearness, and that of nearness times disparity. Rows as for
 * tally; at most RF_MOST_CORE_COLUMNS columns, so that the sums of a row fit 32 bits.
 */
enum { RF_MOST_CORE_COLUMNS = 256 };
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
static_assert((uint64_t)RF_MOST_CORE_COLUMNS * 255 * 65535 <= UINT32_MAX, "a row fits 32 bits");
typedef struct rf_core_sums rf_core_sums_fn(const struct rf_core_window *window);

#endif
