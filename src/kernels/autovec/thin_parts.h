/* thin_parts.h: types and constants that the files of find_thin share. Each of these is compiled
 * once as plain C and once for each instruction set, with RF_VEC_SET as its name.
 *
 * Tests of all pixels are made a row of a tile at a time, in a copy of the pixels around it. The
 * few pixels that pass them are collected and worked on in batches.
 */
#ifndef RF_KERNELS_THIN_PARTS_H
#define RF_KERNELS_THIN_PARTS_H

#include "kernels/lanes.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    JUMP = 65535 / 32, /* disparities this far apart are two surfaces */
    AROUND = 3,        /* a thin pixel has something far within 7 x 7 pixels */
    THIN = 2 * AROUND + 1,
    WIDE = 2 * THIN,     /* more pixels across than any thin structure has */
    FAR = RF_THIN_REACH, /* how far the hidden background is looked for */
    CLEAN = 4,           /* pixels: nearer light may be that of the edge itself */
    BEFORE = 2,          /* how far N is looked for */
    ACROSS = 2 * BEFORE + 1,
    FAINT = 12 * 12, /* squared distance of light that is none */
    BRIGHT = 4000,   /* light of highlights, and of pixels that are clipped: no mixture has it */
    LEAST = 12,      /* alpha that a far pixel must have */
    WHITE = 4095,

    MARGIN = FAR + 1, /* around a tile */
    SPAN = RF_TILE + 2 * MARGIN,
    ROW = 40,         /* elements of a row of them */
    INNER = SPAN - 2, /* without the first and the last */
    WAYS = 8,
    BATCH = 32,          /* pixels that are looked at together */
    WIDER = RF_TILE + 8, /* loops of 16 are unrolled, and then not vectorised */
};

/* sum / by, rounded down, for quotients below 2^13 and by < 2^30. `real` is the sum in
 * single precision, so that its quotient is less than 1 off; then the low 32 bits of
 * the sum, whatever is above them, tell whether it is. */
static inline int32_t quotient(float real, uint32_t sum, uint32_t by)
{
    const int32_t q = (int32_t)(real / (float)(int32_t)by);
    const int32_t left = (int32_t)(sum - (uint32_t)q * by);

    return q + (left < 0 ? -1 : 0) + (left >= (int32_t)by ? 1 : 0);
}

/* Four axes both ways, the slanted ones last. */
static const int8_t way[WAYS][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                    {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

/* The tile and what is around it; pixel (x, y) at [y + MARGIN][x + MARGIN]. */
struct rf_thin_window {
    uint16_t map[SPAN][ROW];    /* 65535 beyond the photo, which is never far */
    uint16_t clean[SPAN][ROW];  /* 65535 where a pixel is not clean */
    uint16_t inside[SPAN][ROW]; /* 0 beyond the photo, which is never near */
    uint16_t (*before)[ROW];    /* `inside`, or `map` */
    uint16_t most[RF_TILE][WIDER], least[RF_TILE][WIDER]; /* over 3 x 3, over 7 x 7 */
};

/* A row of a tile, pixel by pixel. */
struct rf_thin_row {
    uint16_t level[RF_TILE];
    uint16_t kept[RF_TILE], look[RF_TILE], thin[RF_TILE]; /* masks */
    uint16_t width[RF_TILE];
    /* Steps, less one, to the first far pixel, FAR: none; from the first step on to a far one, up
     * to THIN + 1; and to what F is the mean of. */
    uint16_t near[WAYS][RF_TILE], beside[WAYS][RF_TILE], hit[WAYS][RF_TILE];
};

/* Pixels, what is hit in all directions, and how much each counts: by the inverse
 * square of its distance. Pixels beyond `count` hit nothing. */
struct rf_thin_batch {
    int count;
    uint8_t at[BATCH];                 /* 16 y + x */
    uint16_t kept[BATCH], thin[BATCH]; /* masks */
    uint16_t level[BATCH], own[BATCH]; /* disparity */
    uint16_t light[3][BATCH];          /* C */
    uint16_t weight[WAYS][BATCH], disparity[WAYS][BATCH], hit[3][WAYS][BATCH];
};

/* Results of the kernel for the pixels of a batch. */
struct rf_thin_mixture {
    uint16_t far[BATCH];                               /* disparity of F */
    uint16_t near[BATCH];                              /* nearest of N, 0: there is none */
    int32_t mixed[BATCH];                              /* C is not F's own */
    int32_t contrast[BATCH];                           /* (C - F)^2 */
    int32_t far_light[3][BATCH], near_light[3][BATCH]; /* F, N */
    int32_t alpha[BATCH];
};

/* The near pixels around one, RF_THIN_TAPS of them; others are 0. */
enum { RF_THIN_TAPS = 32 };

struct rf_thin_taps {
    uint16_t near[RF_THIN_TAPS], light[3][RF_THIN_TAPS];
};

/* False: there is nothing to find in this tile. */
bool RF_VEC(rf_thin_window)(struct rf_thin_window *w, const struct rf_thin_tile *t);

/* A bit for each pixel of row y of a tile that is to be looked at more closely. */
unsigned RF_VEC(rf_thin_row)(struct rf_thin_row *row, const struct rf_thin_window *w, int y,
                             int columns);

/* F, and what is mixed; weights are left of what is of F's surface. */
void RF_VEC(rf_thin_far)(struct rf_thin_mixture *m, struct rf_thin_batch *b);

/* N, as far as it is needed, and alpha; `taps` is memory for a batch of them. */
void RF_VEC(rf_thin_near)(struct rf_thin_mixture *m, const struct rf_thin_batch *b,
                          const struct rf_thin_tile *t, const struct rf_thin_window *w,
                          struct rf_thin_taps *taps);

#endif
