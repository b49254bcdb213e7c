/* thin.h: the contract of find_thin, which finds the pixels of wires and hair, and those at
 * silhouettes. */
#ifndef RF_KERNELS_THIN_H
#define RF_KERNELS_THIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { RF_THIN_REACH = 10, RF_THIN_SHARE = 20480 };

/* A mixture: a pixel of which alpha is of something near and the rest of its background. */
struct rf_thin {
    uint8_t at;    /* 16 y + x in its tile */
    uint8_t alpha; /* 255 = 1 */
    uint16_t near_disparity, far_disparity;
    uint16_t light[3]; /* F, Q12 */
    /* By the caller's matte it is the light as a pixel of N alone, Q12: alpha N and (1 - alpha)
     * times the mean light of the background. Of Y, U and V it is D_b and D_r of F, or those of the
     * photo while the planes hold F. */
    uint16_t whole[3];
    bool thick; /* N is no thin structure, or is the caller's matte: it is not splatted */
};

/* A tile of a photo in planes, of pixel (0, 0) on, rows `stride` apart. The photo goes
 * on for so many pixels to the left of it and above it, and ends so many to the right
 * and below; what is beyond need not be set, but up to 5 elements must be there on all
 * sides. */
struct rf_thin_tile {
    const uint16_t *disparity, *light[3];
    ptrdiff_t stride;
    int left, above, right, below;
};

/*
 * find_thin: which pixels of a tile are mixtures, C = alpha N + (1 - alpha) F, and of
 * what (thin/thin.h); those found first by rows, `most` of them at the most. Returns
 * how many. It works in RF_THIN_SHARE bytes at `share`, aligned as any type.
 *
 * With J = 65535 / 32, and where only pixels of the photo count:
 *
 *     kept        the greatest disparity of the 3 x 3 around is no more than J above its own
 *     level       own - J of a pixel that is kept, own + J of others
 *     near, far   above the level, at most the level
 *     clean       far, and kept
 *
 * Looked at are those that are not kept, and those that are J above the least of the 7 x 7
 * around them. In eight directions, up to RF_THIN_REACH steps:
 *
 *     width       of what is kept: steps from far pixel to far pixel less one, the least of
 *                 four axes; of others: pixels in a row that are near, begin at the first or
 *                 the second step and end before a far one, the least of eight directions.
 *                 Thin is a width of 7 at the most
 *     hit         the first clean pixel of each direction, one of them at 4 steps or nearer;
 *                 else, or if the width is 1, the first far one
 *     weight      1440 / squared distance, rounded down
 *     surface     the disparity d that was hit with the most weight within 2 J of it, the least of
 *                 equals
 *     F, spread   mean by weight of those hit within 2 J of it, half up; mean of their
 *                 squared distances from F, rounded down
 *     N           mean, half up, of near pixels of the 5 x 5 around by 1 + sum of
 *                 (L - F)^2 / 64, each rounded down
 *     alpha       255 (N - F)(C - F) / (N - F)^2, rounded down; 0 if (N - F)^2 < 2304,
 *                 or if C is more than 30 degrees off the line from F to N: a^2 < n c - [n c / 4]
 *                 with a = (N - F)(C - F) / 1024, n and c the same of the squares of N - F and
 *                 C - F, all rounded down; else no less than keeps C - (1 - alpha) F between 0 and
 *                 alpha white
 *
 * None is what is kept and not thin, has no N, or has light above 4000 in N or C; what is not kept
 * and has an alpha below 12, or (C - F)^2 < 2 spread + 144, 8 spread if it is not thin: there, only
 * the light tells a mixture. What is kept has then, and with 0, an alpha of 255. The near disparity
 * is its own of what is kept, else the greatest of N's; the far one is d.
 */
typedef int rf_find_thin_fn(struct rf_thin *out, const struct rf_thin_tile *tile, int most,
                            void *share);

#endif
