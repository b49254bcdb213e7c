/* edges.h: contracts of the loops that put the edges of a disparity map in their place. */
#ifndef RF_KERNELS_EDGES_H
#define RF_KERNELS_EDGES_H

#include <assert.h>
#include <stdbool.h>
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
 * block_ranges: the least and the greatest disparity of each block of a row of them, which is
 * `width` elements wide and `rows`, 1 to RF_EDGE_BLOCK, high; the last block may be narrower.
 */
enum { RF_EDGE_BLOCK = 8 };
struct rf_edge_range {
    uint16_t least, most;
};
typedef void rf_block_ranges_fn(struct rf_edge_range *range, const uint16_t *plane,
                                ptrdiff_t stride, int width, int rows);

/*
 * climb: the next step along the steepest way up, or down, from each pixel of a cell. `from` holds
 * the disparities that ways have come to before this step, and `to` receives those after it: from[]
 * of the neighbour that `direction` names, or the pixel's own. Steps are modulo 2^16. A way ends
 * before its first step that is less than `flat`, at least 1, or than largest / RF_RAMP_ENDS. So
 * where length == step - 1 and the step is neither,
 *
 *     end = to, largest = max(largest, the step), length = step
 *
 * Whether that was so anywhere is returned. Up to RF_CLIMB_CELL rows and columns, and of `from` the
 * elements around them, too, which `to` does not overlap.
 */
enum { RF_CLIMB_CELL = 16, RF_RAMP_ENDS = 12 };
struct rf_climb_cell {
    const uint8_t *direction; /* as steepest writes them */
    bool down;
    const uint16_t *from;
    uint16_t *to, *end, *largest, *length;
    ptrdiff_t stride; /* every plane has it */
    int columns, rows;
    uint16_t flat, step; /* step: the number of this one */
};
typedef bool rf_climb_fn(const struct rf_climb_cell *cell);

/*
 * binomial8 and binomial16: row[1] smoothed by a binomial 3x3 mean: 16 times it, of codes; of
 * disparities it is rounded down. binomial8 and the three below: elements -1 to n of each row are
 * read.
 */
typedef void rf_binomial8_fn(uint16_t *out, const uint8_t *const row[3], int n);
typedef void rf_binomial16_fn(uint16_t *out, const uint16_t *const row[3], int n);

/*
 * photo_gradient: with Sobel's operator an eighth of (right, down), each rounded towards 0, of
 * codes at most 16 * 255; it replaces (gx, gy) where it is longer.
 */
typedef void rf_photo_gradient_fn(int16_t *gx, int16_t *gy, const uint16_t *const row[3], int n);

/* map_slope: sqrt(right^2 + down^2) / 8 by Sobel's operator, in single precision, rounded down. */
typedef void rf_map_slope_fn(uint16_t *slope, const uint16_t *const row[3], int n);

/*
 * edge_support: adds how much of an edge of this direction the photo has at each pixel of a window,
 *
 *     sum[columns * y + x] += min(|normal_x gx + normal_y gy| >> 7, RF_MOST_PHOTO_EDGE)
 *
 * Normals are Q7, at most 127; gradients at most 2040.
 */
enum { RF_MOST_PHOTO_EDGE = 40 * 16 };
struct rf_edge_window {
    const int16_t *gradient_x, *gradient_y; /* at the window's first pixel */
    ptrdiff_t stride;
    int rows, columns; /* 8 or 12 columns */
    int normal_x, normal_y;
};
typedef void rf_edge_support_fn(int32_t *sum, const struct rf_edge_window *window);

/* greatest: the greatest element of `rows` rows, at least one, at each of n places. */
typedef void rf_greatest_fn(uint16_t *out, const uint16_t *const *row, int rows, int n);

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
