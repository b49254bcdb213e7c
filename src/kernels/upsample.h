/* upsample.h: contracts of the kernels of the depth upsampler. */
#ifndef RF_KERNELS_UPSAMPLE_H
#define RF_KERNELS_UPSAMPLE_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

/* Where a pixel lies among the samples of its row or column. */
enum { RF_TAPS = 4 };
struct rf_taps {
    int32_t first;             /* the first of four samples, -2 to samples - 2 */
    int16_t share[RF_TAPS];    /* Q15, of sum 1, for means */
    uint16_t near_by[RF_TAPS]; /* Q16, for the choice of a surface */
    int16_t middle; /* where it lies between the second and the third, -1/2 to 1/2 in Q15 */
};

/* blend4: four rows by shares in Q15 that are not negative and add up to 1, rounded half up. */
typedef void rf_blend4_fn(uint16_t *out, const uint16_t *const row[RF_TAPS],
                          const int16_t share[RF_TAPS], int n);

/* widen4: n pixels of a row out of samples, 2^15 + sum of share[k] (in[first + k] - 2^15), half
 * up. */
typedef void rf_widen4_fn(uint16_t *out, const uint16_t *in, const struct rf_taps *taps, int n);

/*
 * Cells, the pixels between the same samples, for the depth upsampler. The 4 x 4 samples around
 * a cell are its taps, and it is rough where two neighbours among them are more than `step`
 * apart, or where one is trusted less than wholly (255). If that is so only with those in the
 * corners, which are 1/36 of the mean at the most, it is rough there.
 *
 * rough_cells: which of n cells side by side are, RF_ROUGH, RF_ROUGH_CORNER or 0, and all of them
 * or-ed. Element i of row[j] is a tap of cells i - 3 to i; elements to n + 2 are read. trust[0] ==
 * NULL: all are sure.
 */
enum {
    RF_TAP_COUNT = RF_TAPS * RF_TAPS,
    RF_AROUND = 8,
    RF_CELLS = 32,
    RF_UNLIKE = 32,
    RF_BATCH = 64,
    RF_BATCH_SPARE = 32
};
enum { RF_ROUGH = 1, RF_ROUGH_CORNER = 2 };
typedef unsigned rf_rough_cells_fn(uint8_t rough[RF_CELLS], const uint16_t *const row[RF_TAPS],
                                   const uint8_t *const trust[RF_TAPS], int step, int n);

/*
 * part_taps: the taps of n cells side by side, ascending, and where they are parted: where one is
 * more than 1/44 of the range above the last, or more than 1/8 above the first of its surface. Rows
 * as for rough; those columns of `parts` from n on are of no meaning.
 */
enum { RF_GAP = 65535 / 44, RF_WIDEST = 65535 / 8 };
struct rf_parts {
    uint16_t sorted[RF_TAP_COUNT][RF_CELLS];
    uint16_t starts[RF_CELLS]; /* bit i: sorted[i] is the first of a surface */
};
typedef void rf_part_taps_fn(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int n);

/*
 * The 8 x 8 samples around a cell, of which the middle ones are its taps, column by column: element
 * 8 i + j is that of column i and row j. So those of the next cell begin 8 elements on.
 */
struct rf_window {
    const uint16_t *disparity;
    const uint8_t *colour[3]; /* quartered */
    const uint8_t *trust;     /* 255 = sure, or NULL: all are */
};

/* transpose8, turn16: RF_TURNED columns of 8 rows laid end to end. */
enum { RF_TURNED = RF_CELLS + RF_AROUND };
typedef void rf_transpose8_fn(uint8_t out[RF_AROUND * RF_TURNED],
                              const uint8_t *const row[RF_AROUND]);
typedef void rf_transpose16_fn(uint16_t out[RF_AROUND * RF_TURNED],
                               const uint16_t *const row[RF_AROUND]);

struct rf_surface {
    uint64_t samples;     /* bit 8 i + j: that of column i and row j shows what it looks like */
    uint16_t taps;        /* bit 4 i + j */
    uint16_t low, range;  /* disparities from low to low + range */
    uint16_t grow, scale; /* grow whole: samples times it are at most 127; scale Q16 */
    int16_t mean;         /* at the middle of the cell, above low; |.| < 2^14 */
    int16_t right, below; /* a sample on from there; |.| < 2^14 */
};

struct rf_cell {
    int surfaces;                 /* at least 1 */
    int greatest;                 /* the surface that has the most taps */
    bool sure;                    /* every tap is trusted wholly */
    uint16_t trust[RF_TAP_COUNT]; /* Q16 */
    struct rf_surface surface[RF_TAP_COUNT];
};

/*
 * find_surfaces: the surfaces of a cell, whose taps `part` put in column `at` of `parts`. Samples
 * belong to the surfaces that they continue, at most 1/88 beyond. Those that are trusted less than
 * half say nothing about colour; a cell that has only such taps is taken as sure. Of more than 40
 * samples, those of a checkerboard are taken.
 */
typedef void rf_find_surfaces_fn(struct rf_cell *cell, const struct rf_window *window,
                                 const struct rf_parts *parts, int at);

/* How pixels that are looked at together lie among the taps of their cell. */
struct rf_placement {
    uint16_t near_by[RF_TAP_COUNT][RF_BATCH]; /* Q16, of sum < 1; column by column */
    uint16_t all[RF_BATCH];                   /* the sum */
    int16_t x[RF_BATCH], y[RF_BATCH]; /* from the cell's middle, samples in Q15, |.| <= 1/2 */
};

/*
 * choose_surface: disparities of n pixels of a cell. A pixel weighs each surface by how near its
 * taps are and by how much the photo here looks like the photo at all its samples,
 *
 *     prior = sum over its taps t of near_by[t] (trust[t], unless the cell is sure)
 *     alike = sum over its samples i of rf_likeness[|colour - colour[i]|], from 9 on of 0
 *     score = prior (4 (alike grow scale) + RF_UNLIKE)
 *
 * with 1-norms of colours in steps of four codes, and takes the plane of the one that scores
 * most, the first of equal ones,
 *
 *     low + min(max(mean + right x + below y, 0), range)
 *
 * All are Q16, products of weights are rounded down, those of the plane half up. sure = 255 where
 * it scores more than four times the second, else 0.
 *
 * n is at most RF_BATCH and is rounded up to 32: out and sure may be written so far. Colours
 * are read so far, too: it is quickest if there is none that no pixel has.
 */
/* (124 - 11 i)^4 / 2^20 */
static const uint8_t rf_likeness[16] = {225, 155, 103, 65, 39, 21, 10, 4, 1};
static_assert(RF_AROUND * RF_AROUND * 225 <= UINT16_MAX,
              "the likeness of all samples fits 16 bits");
static_assert(127 * 225 <= UINT16_MAX, "and so it does when it is grown,");
static_assert(4 * 64 * 225 + RF_UNLIKE <= UINT16_MAX, "and so does the evidence");
typedef void rf_choose_surface_fn(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH],
                                  const struct rf_cell *cell, const struct rf_window *window,
                                  const struct rf_placement *placement,
                                  uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], int n);

/* quarter: colours of n pixels of 3 or 4 bytes, of which the first three, in steps of
 * four codes. */
typedef void rf_quarter_fn(uint8_t *const out[3], const uint8_t *pixels, int bytes, int n);

/*
 * median3: the rows' middle one, but where it is not sure, the 3 x 3 around weighed, four for what
 * is sure (255) and one for what is not (0): the least that more than 3/5 of the weights are at or
 * below, in even steps. A median that leans to the near: what is thin is in front. Elements -1 to n
 * of the rows are read.
 */
typedef void rf_median3_fn(uint16_t *out, const uint16_t *const row[3],
                           const uint8_t *const sure[3], int n);

#endif
