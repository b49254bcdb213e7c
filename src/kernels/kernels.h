/* kernels.h: the compute loops and their contracts.
 *
 * NAME.c is the reference, as plain as the contract, always built. NAME_vec.c computes
 * the same bits with the operations of simd/vec.h. Files named rows_*.c are plain C written
 * for the compiler's vectoriser; they are compiled once more for each instruction set.
 */
#ifndef RF_KERNELS_H
#define RF_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "colour/yuv.h"
#include "kernels/discs.h"
#include "kernels/thin.h"
#include "kernels/upsample.h"
#include "tiles/slab.h"

/*
 * Rays of a tile are a chunk at a time; what they look at is found out for strips of the tile,
 * RF_STRIP rows each.
 */
enum { RF_RAY_CHUNK = 64, RF_STRIP = 8, RF_STRIP_LANES = RF_TILE * RF_STRIP };

/*
 * ranges: the least and the greatest blur of cells of RF_CELL x RF_CELL pixels, and then of
 * windows of RF_WINDOW_X x RF_WINDOW_Y cells to the right of and below a cell: whatever a
 * strip that begins in that cell covers. A range is (least & 0xffff) | most << 16, with most
 * rounded up to an even number: its lowest bit is RF_BARE.
 *
 * cells: one row of n cells from the four rows at `blur`.
 * windows: one row of windows from RF_WINDOW_Y rows of n cells, whose ends are repeated: the
 * first begins `border` cells to the left, the last n - 1 + border to the right. The scratch is
 * 2 (n + 2 border + RF_WINDOW_X - 1) long. RF_BARE is clear.
 *
 * A window is bare where the background layer shows of what is deepest in it just what the picture
 * shows: nothing within rf_bare_depth(), which is more than a slab, of the greatest blur is marked
 * as foreground.
 *
 * foreground: one row of n cells, as cells: the greatest blur of those pixels whose background has
 * another, or RF_NO_BLUR.
 * bare: of one row of windows, from RF_WINDOW_Y rows of such cells, as windows; RF_BARE becomes
 * what it should be. The scratch is n + 2 border + RF_WINDOW_X - 1 long.
 */
enum { RF_CELL = 4, RF_WINDOW_X = RF_TILE / RF_CELL + 1, RF_WINDOW_Y = RF_STRIP / RF_CELL + 1 };
enum { RF_BARE = 1 << 16 };
static inline int rf_bare_depth(int blur)
{
    const int size = blur < 0 ? -blur : blur, part = (size >> 3) + (size >> 5) - 256;

    return part > 320 ? part : 320;
}
static inline int16_t rf_lesser(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static inline int16_t rf_greater(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

static inline int16_t rf_range_least(uint32_t range)
{
    return (int16_t)range;
}
static inline int16_t rf_range_most(uint32_t range)
{
    return (int16_t)(range >> 16 & 0xfffe);
}
typedef void rf_cells_fn(int16_t *least, int16_t *most, const int16_t *blur, ptrdiff_t stride,
                         int n);
typedef void rf_windows_fn(uint32_t *range, const int16_t *const least[RF_WINDOW_Y],
                           const int16_t *const most[RF_WINDOW_Y], int16_t *scratch, int n,
                           int border);
typedef void rf_foreground_fn(int16_t *most, const int16_t *blur, const int16_t *behind,
                              ptrdiff_t stride, int n);
typedef void rf_bare_fn(uint32_t *range, const int16_t *const foreground[RF_WINDOW_Y],
                        int16_t *scratch, int n, int border);

/* aim: where n rays see the blur s: x = round(u s), y = round(v s), half up, as an offset
 * x + y stride, and as one of cells: floor(x / RF_CELL) + floor(y / RF_CELL) cell_stride. */
typedef void rf_aim_fn(int32_t *offset, int32_t *cell, const int16_t *u, const int16_t *v, int blur,
                       int32_t stride, int32_t cell_stride, int n);

/*
 * sort_rays: what the rays of a strip have to look at.
 *
 *     for each ray n:
 *         for k = 0 .. slabs - 1, with the range at range[cell[k][n]]:
 *             no blur in the range is in slab k: go on
 *             all blurs are:                     take its light as the last, offset[k][n]; end
 *             none is deeper, and it is bare:    the last is the background at offset[k][n]; end
 *             else:                              test slab k at offset[k][n]
 *         the last is the background at offset[slabs][n]
 *
 * Slabs k - 1 and k that are both to be tested at one offset are one test of all from the
 * former's low to the latter's end, where the slabs overlap or touch (joined[k]); and the last
 * test is left out where a slab's light is the last and it was tested in slab k - 1 at the same
 * offset. This does not go across multiples of RF_JOIN_BLOCK.
 *
 * Rays come out with fewer tests first, those of RF_SORTED_TESTS - 1 or more at the end, and
 * otherwise in their order. Nothing is lost by all this: tests that are left out could not hit,
 * would all hit, or lead to the same light. Only where `beneath` is set are deepest slabs that are
 * bare not tested: what is in the slab has the same light in the background, and what is not is
 * nearer and was not met, so that the ray passes beneath it, most likely to this slab. A third of
 * all tests is of that kind. Slabs wider than the least rf_bare_depth() of their blurs are tested.
 */
enum { RF_SORTED_TESTS = 8, RF_JOIN_BLOCK = 16 };

struct rf_sort_job {
    const uint32_t *range;          /* at the strip's first pixel, */
    const uint32_t *below;          /* and at that of the strip below, if both are one; else NULL */
    const uint16_t *front, *behind; /* first of three planes of light, there */
    const uint16_t *weight, *behind_weight; /* for sweep_weighted, else NULL: see there */
    int rays, slabs;
    bool beneath;
    const struct rf_slab *slab;
    const bool *joined;                                           /* [slabs]: slab k to k - 1 */
    const int32_t (*offset)[RF_RAY_CHUNK], (*cell)[RF_RAY_CHUNK]; /* [slabs + 1], [slabs] */
    const int32_t (*weight_offset)[RF_RAY_CHUNK];                 /* [slabs] */

    /* Rays 0 to shared - 1 are those of chroma, too, with planes and offsets of its own, and of the
     * same weights. What a ray of luma need not look for in a whole tile, chroma need not, either:
     * round(u s / 2) samples are at most a pixel from round(u s), and ranges are of whole
     * cells, which begin at even pixels. */
    int shared;
    const int32_t (*chroma_offset)[RF_RAY_CHUNK], (*chroma_weight_offset)[RF_RAY_CHUNK];
    const uint16_t *chroma_front, *chroma_behind;
};

struct rf_sorted_rays {
    int rays;
    uint8_t tests[RF_RAY_CHUNK];
    uint8_t begin[RF_SORTED_TESTS + 1]; /* ray that those of so many tests begin at; `rays` */
    /* Test t, nearest first, at offset[t], hits where rf_in_range(from[t], to[t], blur). */
    int32_t offset[RF_BINS][RF_RAY_CHUNK];
    uint16_t from[RF_BINS][RF_RAY_CHUNK], to[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last[RF_RAY_CHUNK]; /* first of three planes, for the strip's first pixel */

    /* Only with weights: as `offset` and `last`, of the weights. */
    int32_t weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *last_weight[RF_RAY_CHUNK];
    bool last_behind[RF_RAY_CHUNK]; /* which plane last_weight is in */

    /* How many of those with so many tests are shared: the first ones, for which, as `offset` and
     * `last`, of chroma: */
    uint8_t shared[RF_SORTED_TESTS];
    int32_t chroma_offset[RF_BINS][RF_RAY_CHUNK], chroma_weight_offset[RF_BINS][RF_RAY_CHUNK];
    const uint16_t *chroma_last[RF_RAY_CHUNK], *chroma_last_weight[RF_RAY_CHUNK];
};
typedef void rf_sort_rays_fn(struct rf_sorted_rays *sorted, const struct rf_sort_job *job);

/*
 * sweep: rays of one strip.
 *
 *     for each ray n and pixel p of the strip:
 *         for t = 0 .. tests[n] - 1:
 *             q = p + offset[t][n]
 *             if rf_in_range(from[t][n], to[t][n], blur[q]):
 *                 sum += light[q]; next ray
 *         sum += last[n][p]
 *
 * Light is at most 65535 / steps; sums are exact. Pointers are to the strip's first pixel.
 * Where sum[3] is not NULL, the weights of what is hit are added up there: no more than that, and
 * lying as those of sweep_weighted.
 */
/* Light that highlights reach: white, 4, 8 or 16 times that. */
enum rf_bright { RF_WHITE, RF_BRIGHT, RF_BRIGHTER, RF_BRIGHTEST };

struct rf_sweep_job {
    const int16_t *blur;     /* light is in the three planes after it, pitch apart */
    ptrdiff_t stride, pitch; /* elements */
    const struct rf_sorted_rays *rays;
    int steps;             /* of sweep: values that a 16-bit sum holds, 1 to 16 */
    enum rf_bright bright; /* of sweep_weighted */
    int lanes;             /* those of an even number of rows, of RF_STRIP at most */

    /* weights of the front, 1 to RF_WEIGHT_MAX in sweep_weighted */
    const uint16_t *weight;
    ptrdiff_t weight_stride;
};
typedef void rf_sweep_fn(uint32_t *const sum[4], const struct rf_sweep_job *job);

/* sweep_weighted: the same, where light, Q12 up to `bright`, counts weight times; sum[3] is that
 * of weights. Those of the front lie in a plane with a stride of its own, those of the background
 * as its light. Never RF_BRIGHTEST but for the reference. */
enum { RF_WEIGHT_MAX = 32767 };
typedef void rf_sweep_weighted_fn(uint64_t *const sum[4], const struct rf_sweep_job *job);

/* Focus and blur in fixed point. */
struct rf_focus {
    uint16_t disparity; /* df, Q16 with 65535 = 1 */
    uint16_t radius;    /* K in Q8.8, scaled by 65536 / 65535 */
};

/*
 * signed_blur: s = K (df - d), Yang et al. 2016, eq. 4. Q7.8 pixels, rounded half up in
 * magnitude: within 1/512 pixel for this focus, within 1.25/256 of that of real K and df.
 */
typedef void rf_signed_blur_fn(int16_t *blur, const uint16_t *disparity, struct rf_focus focus,
                               int n);

/*
 * smooth3, of three planes: a third of the way from a pixel to each of its two neighbours, `apart`
 * elements before and after, whose blur is within an eighth of its own, but at least one pixel
 * (256) and less than two (511), of it. That is the mean of three of a kind. It begins where
 * |blur| > least and comes in over the next `over` of blur, 1 at least. Light is at most 4 * 4095
 * here and below, so that the way to both fits 16 bits. The rows written are not among those read.
 *
 * rf_smooth_share(): of the way to both, Q15, half up.
 */
enum { RF_SMOOTH_THIRD = 10923 };
static inline int rf_smooth_share(int blur, int least, int over)
{
    const int above = (blur < 0 ? -blur : blur) - least;
    const int in = above < 0 ? 0 : above < over ? above : over;

    return in * (65535 / over) * RF_SMOOTH_THIRD >> 16;
}
typedef void rf_smooth3_fn(uint16_t *const out[3], const uint16_t *const light[3],
                           const int16_t *blur, ptrdiff_t apart, int least, int over, int n);

/* The cone of the background mark falls by half a pixel a pixel; Q7.8. */
enum { RF_CONE_STEP = 128, RF_CONE_DIAGONAL = 181 };

/* What no blur is: an unknown pixel of the background. */
enum { RF_NO_BLUR = INT16_MIN };

/*
 * spread_row: grey dilation of a row by the cone to both sides, of values at most
 * `reach` cone steps apart, reach at most 2 RF_SPREAD_MARGIN - 1. Values are s + 2^15.
 * Returns where the result is, row or spare; both are n long, with RF_SPREAD_MARGIN
 * elements before and after them that are overwritten.
 */
enum { RF_SPREAD_MARGIN = 256 };
typedef uint16_t *rf_spread_row_fn(uint16_t *row, uint16_t *spare, int reach, int n);

/* dilate_from: the cone from the three nearest pixels of the row before or after, whose
 * elements -1 and n are read. Values are s + 2^15. */
typedef void rf_dilate_from_fn(uint16_t *row, const uint16_t *before, int n);

/* mark: the blur of pixels that are not foreground, RF_NO_BLUR of those whose dilated value
 * is more than half a pixel above their own. `dilated` is s + 2^15. */
typedef void rf_mark_fn(int16_t *behind, const int16_t *blur, const uint16_t *dilated, int n);

/* push: n parents of 2 x 2 children: the mean of the known ones, half up, and their
 * farthest blur; 0 and RF_NO_BLUR if none is known. */
typedef void rf_push_fn(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
                        const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1,
                        int n);

/* pull: unknown ones of 2 x pairs children take 3 and 1 quarters of the nearest parents, down
 * and then across, each half up; `mixed` is scratch of pairs + 2. pull_blur: they take their
 * parent's blur. */
typedef void rf_pull_fn(uint16_t *out, const int16_t *out_blur, const uint16_t *near_row,
                        const uint16_t *far_row, uint16_t *mixed, int pairs);
typedef void rf_pull_blur_fn(int16_t *out, const int16_t *near_row, int pairs);

/* means: Q14 means of sums of N Q12 values, with scale = rf_mean_scale(N): within
 * 1/2 + N / 2^17 of 4 sum / N, and exact where all N are the same. */
typedef void rf_means_fn(uint16_t *mean, const uint32_t *sum, uint32_t scale, int n);
static inline uint32_t rf_mean_scale(uint64_t rays)
{
    const uint64_t scale = ((UINT64_C(1) << 32) + rays / 2) / rays;

    return scale > UINT32_MAX ? UINT32_MAX : (uint32_t)scale;
}

/*
 * Codes of a disparity map that has few of them; src/depth/dequantise.h says why.
 *
 * smooth_codes: a 3x3 binomial mean of row[1], with neighbours `apart` pixels to either side and in
 * row[0] and row[2], of which pixels -apart to n - 1 + apart are read:
 *
 *     out = own + (sum of w (neighbour - own) + 8 >> 4)
 *
 * w is 2 beside, above and below, and 1 in the corners; but 0 for two opposite neighbours of which
 * one's code is more than `most` away: so a plane stays one up to its edge. most <=
 * RF_MOST_SMOOTHED, so sums stay below 2^15.
 * clamp_codes: each code becomes the smooth value, or what is nearest to it within `most`.
 */
enum { RF_MOST_SMOOTHED = (32767 - 8) / 12 };
typedef void rf_smooth_codes_fn(uint16_t *out, const uint16_t *const row[3], int apart,
                                uint16_t most, int n);
typedef void rf_clamp_codes_fn(uint16_t *code, const uint16_t *smooth, uint16_t most, int n);

/* at_most: none of n values above `most`. */
typedef void rf_at_most_fn(uint16_t *value, uint16_t most, int n);

/* weighted_means: Q14 means of n <= RF_TILE * RF_TILE sums below 2^51 of Q12 values times
 * weights, and of their weights: 4 sum / weight half up, to 2^-35; exact where all values are
 * the same. In double precision, whose four operations are the same everywhere. */
typedef void rf_weighted_means_fn(uint16_t *mean, const uint64_t *sum, const uint64_t *weight,
                                  int n);

/*
 * weigh: weights of n pixels of both layers, and their light times weight.
 *
 *     weight = light_weight[min(max(R, G, B), RF_LIGHT_MAX)] / 8                          Q12
 *     light  = round(2 weight light), 2 round(weight light) of light above 16383          Q13
 *
 * Light is Q12, at most 8 RF_LIGHT_MAX; halves up. brightest[i] becomes the brightest light of
 * pixels RF_TILE i and after, where it exceeds that.
 */
struct rf_weigh_job {
    uint16_t *near[3], *far[3];
    uint16_t *near_weight, *far_weight;
    uint16_t *brightest;
    const uint16_t *light_weight; /* RF_LIGHT_MAX + 1, Q15 */
};
typedef void rf_weigh_fn(const struct rf_weigh_job *job, int n);

/*
 * weigh1: the same of one plane, all of whose light is
 *
 *     light = round(2 weight light)                                                        Q13
 *
 * and at most 4 RF_LIGHT_MAX. weigh_chroma: n samples of two values, at most 2^15 - 1, times the
 * weight of the first of every two pixels: round(weight value / 4096), halves up. */
struct rf_weigh1_job {
    uint16_t *near, *far;
    uint16_t *near_weight, *far_weight;
    uint16_t *brightest;
    const uint16_t *light_weight;
};
typedef void rf_weigh1_fn(const struct rf_weigh1_job *job, int n);
typedef void rf_weigh_chroma_fn(uint16_t *chroma, const uint16_t *weight, int n);

/* weighed_means: Q14 means of n sums below 2^31 of Q13 light times Q12 weight, and of the
 * weights: 2^13 sum / weight half up, at most 65520. In single precision, one operation after
 * the other: within 1/2 + 2^-6. */
typedef void rf_weighed_means_fn(uint16_t *mean, const uint32_t *sum, const uint32_t *weight,
                                 int n);

/* between_rows: a tile of means from some of its rows, 2, 3 or 5 apart (methods/tile_rows.h), by
 * the cubics through four of them, half up, never beyond the one before and the one after. */
typedef void rf_between_rows_fn(uint16_t *mean, const uint16_t *computed, int step);

/* soften: rows of RF_TILE means, `each` of which are a pixel's, moved by half of share / 65536,
 * rounded down, of how far the average, half up, of its neighbours' is: those to the left and
 * right, but at the ends, and then, if `down` is set, those above and below, but in the first and
 * the last row. */
typedef void rf_soften_fn(uint16_t *mean, int rows, int each, bool down, uint16_t share);

/*
 * lay_veil: over the 16 x 16 means at mean[0] to mean[2], at most 65535, what is drawn
 * in cells of 4 x 4 pixels (thin/veil.h): 6 x 6 of them, the first one above and to the
 * left of the tile, each of light times cover and cover, Q12 times 2^RF_VEIL_SHIFT,
 * between -2 and 2. Between the middles of cells it is linear, rounded down twice, at
 * 2^-8 of Q12 and at Q14.
 *
 *     mean = light + mean - round(cover mean), 0 to 65535;  cover from 0 to 1
 */
enum { RF_VEIL_CELLS = 6, RF_VEIL_SHIFT = 14 };
typedef void rf_lay_veil_fn(uint16_t *const mean[3], int32_t cell[RF_VEIL_CELLS][RF_VEIL_CELLS][4]);

/* brightest: the largest value of any channel of a row. */
typedef uint16_t rf_brightest_fn(const uint16_t *red, const uint16_t *green, const uint16_t *blue,
                                 int n);

/*
 * search: rays of one strip by the randomized intersection search, plain sums.
 *
 *     for each ray and pixel p of the tile:
 *         guess = blur[p + start]
 *         repeat: q = p + round(u guess), seen = blur[q], until |seen - guess| <= within or
 *                 `tests` are made; guess = seen before each further one
 *         sum += light[q], or light[p] if the last test failed and seen > blur[p]
 *
 * round() is half up, of Q15 times Q7.8. Pointers are to the strip's first pixel.
 */
struct rf_search_rays {
    int rays;
    int32_t start[RF_RAY_CHUNK];              /* elements */
    int16_t u[RF_RAY_CHUNK], v[RF_RAY_CHUNK]; /* Q15 */
    int32_t within[RF_RAY_CHUNK];             /* Q7.8, 0 to 32766 */
};
struct rf_search_job {
    const int16_t *blur;
    const uint16_t *light[3];
    ptrdiff_t stride; /* at most 2^20 */
    int tests;
    const struct rf_search_rays *rays;
};
typedef void rf_search_fn(uint32_t *const sum[3], const struct rf_search_job *job);

/* tolerances: the largest |s - s'| that half a pixel allows a ray: 1/2 / |u|, in Q7.8, rounded
 * down; at most 32766, which is short of it only where u s rounds to 0 for all s. */
typedef void rf_tolerances_fn(int32_t *within, const int16_t *u, const int16_t *v, int n);

/*
 * settle: which of some rays the first test of a search settles for a whole strip: those whose
 * first guesses all lead the same way, to blurs that, by the ranges there (windows, above),
 * confirm them all or, in a search of one test, lie nowhere above those of the strip.
 * settled[i] tells, 1 or 0, and then offset[i] is where the light is. `range` is at the
 * strip's first pixel, cell[i] the offset of the first guesses; a stride is at most 2^20.
 */
typedef void rf_settle_fn(uint8_t *settled, int32_t *offset, const uint32_t *range,
                          const int32_t *cell, const struct rf_search_rays *rays, int tests,
                          int32_t stride, int32_t cell_stride);

/*
 * sweep1: as sweep, of one plane and of some rows of a tile: those of the first half `apart`
 * elements apart, those of the second as far, from `half` elements after the first row on.
 * Light is at most 65535 / steps; sums are exact. `last` of the rays is in that plane. Of chroma
 * only rays that are shared count, with its offsets and its last, and blurs come twice.
 */
struct rf_sweep1_job {
    const int16_t *blur;
    const uint16_t *light;
    ptrdiff_t apart, half;
    int rows;  /* an even number, 16 at most */
    int steps; /* values that a 16-bit sum holds, 4 to 16 */
    bool chroma;
    const struct rf_sorted_rays *rays;

    const uint16_t *weight; /* of the tile's first pixel; at most 4095 but for sweep1_weighted */
    int down;               /* rows of weights are 1 << down times as far apart */
};

/* With weight_sum, not NULL, the weights of what is hit are added up there: no more than that, and
 * lying as those of sweep1_weighted. */
typedef void rf_sweep1_fn(uint32_t *sum, uint32_t *weight_sum, const struct rf_sweep1_job *job);

/* sweep1_weighted: the same, where light counts weight times, 1 to RF_WEIGHT_MAX, and sums of
 * weights. Those of luma lie as its light; elements 2 i and 2 i + 1 of chroma count as the pixel
 * of the first, at chroma_weight_offset. */
typedef void rf_sweep1_weighted_fn(uint64_t *sum, uint64_t *weight,
                                   const struct rf_sweep1_job *job);

/* between_chroma: eight rows from rows 0 2 5 7 of them, as between_rows. */
typedef void rf_between_chroma_fn(uint16_t *mean, const uint16_t *computed);

/* smooth1: smooth3, of one plane. */
typedef void rf_smooth1_fn(uint16_t *out, const uint16_t *light, const int16_t *blur,
                           ptrdiff_t apart, int least, int over, int n);

/*
 * aim_chroma: offsets, as aim, of samples of chroma that are two pixels apart across and 1 << down
 * of them down, two elements of a row each: 2 x + y stride, x = round(u s / 2) and
 * y = round(v s / 2^down); of their pixels: 2 x + 2^down y stride.
 */
typedef void rf_aim_chroma_fn(int32_t *offset, int32_t *pixel, const int16_t *u, const int16_t *v,
                              int blur, int down, int32_t stride, int n);

/* sharpest4: of 2 x 2 blurs the first with the least |s|, twice: n pairs out of rows of 2 n.
 * Blurs are at most 127 pixels. */
typedef void rf_sharpest4_fn(int16_t *out, const int16_t *upper, const int16_t *lower, int n);

/* push1: push, of one plane. */
typedef void rf_push1_fn(uint16_t *out, int16_t *out_blur, const uint16_t *upper,
                         const uint16_t *lower, const int16_t *blur0, const int16_t *blur1, int n);

/* split2: n means of two rows of pairs, half up, the firsts and the seconds apart.
 * join2: pairs of them again.
 * keep2: n pairs become `own` where either of the two pixels has the same blur in front and behind.
 */
typedef void rf_split2_fn(uint16_t *first, uint16_t *second, const uint16_t *upper,
                          const uint16_t *lower, int n);
typedef void rf_join2_fn(uint16_t *out, const uint16_t *first, const uint16_t *second, int n);
typedef void rf_keep2_fn(uint16_t *out, const uint16_t *own, const int16_t *blur,
                         const int16_t *behind, int n);

/*
 * encode: codes of n samples of chroma and of the 2 or 4 pixels that share each to chroma, D_b
 * and D_r of rf_chroma_of() side by side, and luminance. Rows are 2 n long; where there is one
 * row, luma[1] is luma[0] and out[1] is out[0].
 */
typedef void rf_encode_fn(uint16_t *const out[2], uint16_t *chroma, const uint8_t *const luma[2],
                          const uint8_t *uv, const struct rf_yuv_curve *curve, int n);

/*
 * decode: means of a tile of luma and chroma to codes, rf_chroma_code() of each sample and
 *
 *     Y = to_code[L - E] of its pixels
 *
 * with L' the mean of the luminances of the pixels that share a sample: of 2 x 2 if `down`, of
 * 2 x 1 else. Means above white are white. Pixels whose luminance and chroma are what they
 * were, `within` of 4 times `own`, keep their codes; samples all of whose pixels do, too.
 */
struct rf_decode_job {
    const struct rf_yuv_curve *curve;
    int down;
    uint16_t luma[RF_TILE * RF_TILE], chroma[RF_TILE * RF_TILE]; /* rows of RF_TILE, Q14 */
    const uint16_t *own_luma, *own_chroma;               /* Q12, of the tile's first element */
    ptrdiff_t stride;                                    /* of both */
    uint16_t within[2];                                  /* of luma and of chroma; 15 at most */
    uint8_t y[RF_TILE * RF_TILE], uv[RF_TILE * RF_TILE]; /* in: codes that were; out */
};
typedef void rf_decode_fn(struct rf_decode_job *job);

/*
 * series_row: a row of a step of Clenshaw's recursion, on a field V of which a pixel passes
 * some on to its four neighbours,
 *
 *     row = share start + (across (up + down + (left + right)) + own here) - row
 *
 * in single precision; elements -1 and n of `here` are read, and the rows `stride` before and
 * after it. Nothing overlaps.
 */
struct rf_series_job {
    const float *here, *start, *across, *own;
    ptrdiff_t stride; /* elements */
    float share;
};
typedef void rf_series_row_fn(float *row, const struct rf_series_job *job, int n);

struct rf_kernels {
    rf_encode_fn *encode;
    rf_decode_fn *decode;
    rf_sweep1_fn *sweep1;
    rf_sweep1_weighted_fn *sweep1_weighted;
    rf_between_chroma_fn *between_chroma;
    rf_smooth1_fn *smooth1;
    rf_aim_chroma_fn *aim_chroma;
    rf_sharpest4_fn *sharpest4;
    rf_push1_fn *push1;
    rf_split2_fn *split2;
    rf_join2_fn *join2;
    rf_keep2_fn *keep2;
    rf_search_fn *search;
    rf_cells_fn *cells;
    rf_windows_fn *windows;
    rf_foreground_fn *foreground;
    rf_bare_fn *bare;
    rf_aim_fn *aim;
    rf_sort_rays_fn *sort_rays;
    rf_settle_fn *settle;
    rf_tolerances_fn *tolerances;
    rf_sweep_fn *sweep;
    rf_sweep_weighted_fn *sweep_weighted;
    rf_signed_blur_fn *signed_blur;
    rf_smooth3_fn *smooth3;
    rf_spread_row_fn *spread_row;
    rf_dilate_from_fn *dilate_from;
    rf_mark_fn *mark;
    rf_push_fn *push;
    rf_pull_fn *pull;
    rf_pull_blur_fn *pull_blur;
    rf_means_fn *means;
    rf_at_most_fn *at_most;
    rf_smooth_codes_fn *smooth_codes;
    rf_clamp_codes_fn *clamp_codes;
    rf_weighted_means_fn *weighted_means;
    rf_weigh_fn *weigh;
    rf_weigh1_fn *weigh1;
    rf_weigh_chroma_fn *weigh_chroma;
    rf_weighed_means_fn *weighed_means;
    rf_between_rows_fn *between_rows;
    rf_find_thin_fn *find_thin;
    rf_soften_fn *soften;
    rf_lay_veil_fn *lay_veil;
    rf_brightest_fn *brightest;
    rf_draw_disc_fn *draw_disc;
    rf_half_chords_fn *half_chords;
    rf_meets_fn *meets;
    rf_hide_fn *hide;
    rf_blend4_fn *blend4;
    rf_widen4_fn *widen4;
    rf_rough_fn *rough;
    rf_part_fn *part;
    rf_quarter_fn *quarter;
    rf_turn8_fn *turn8;
    rf_turn16_fn *turn16;
    rf_find_surfaces_fn *find_surfaces;
    rf_surface_fn *surface;
    rf_lean3_fn *lean3;
    rf_series_row_fn *series_row;
};

/* The best kernels of an instruction set, enum refocus_cpu; false: this processor or build does
 * not have it. AUTO chooses; *cpu is what it chose. */
bool rf_kernels_select(struct rf_kernels *kernels, uint32_t *cpu);

rf_draw_disc_fn rf_draw_disc_c;
rf_meets_fn rf_meets_c;
rf_hide_fn rf_hide_c;
rf_sweep_fn rf_sweep_c;
rf_sweep1_fn rf_sweep1_c;
rf_sweep1_weighted_fn rf_sweep1_weighted_c;
rf_smooth1_fn rf_smooth1_c;
rf_smooth3_fn rf_smooth3_c;
rf_search_fn rf_search_c;
rf_push_fn rf_push_c;
rf_pull_fn rf_pull_c;
rf_pull_blur_fn rf_pull_blur_c;
rf_sweep_weighted_fn rf_sweep_weighted_c;
rf_weigh_fn rf_weigh_c;
rf_weigh1_fn rf_weigh1_c;
rf_weigh_chroma_fn rf_weigh_chroma_c;

/* Each set overwrites what it does better; rf_kernels_use() calls the others of its set. */
typedef void rf_kernels_use_fn(struct rf_kernels *kernels);
#define RF_VECTOR_SETS(use) use##_neon, use##_sse41, use##_avx2, use##_avx512
#define RF_ALL_SETS(use)    use##_c, RF_VECTOR_SETS(use)
rf_kernels_use_fn RF_VECTOR_SETS(rf_kernels_use), RF_VECTOR_SETS(rf_draw_disc_use),
    RF_VECTOR_SETS(rf_fill_use), RF_VECTOR_SETS(rf_hide_use), RF_VECTOR_SETS(rf_search_use),
    RF_VECTOR_SETS(rf_smooth_use), RF_VECTOR_SETS(rf_sweep1_use),
    RF_VECTOR_SETS(rf_sweep1_weighted_use), RF_VECTOR_SETS(rf_sweep_weighted_use),
    RF_VECTOR_SETS(rf_weigh_use), RF_VECTOR_SETS(rf_weigh1_use);
rf_kernels_use_fn RF_ALL_SETS(rf_aim_use), RF_ALL_SETS(rf_choose_use), RF_ALL_SETS(rf_discs_use),
    RF_ALL_SETS(rf_light_use), RF_ALL_SETS(rf_part_use), RF_ALL_SETS(rf_rows_use),
    RF_ALL_SETS(rf_dequantise_use), RF_ALL_SETS(rf_series_use), RF_ALL_SETS(rf_surfaces_use),
    RF_ALL_SETS(rf_thin_use), RF_ALL_SETS(rf_upsample_use), RF_ALL_SETS(rf_windows_use),
    RF_ALL_SETS(rf_yuv_use), RF_ALL_SETS(rf_yuv_codes_use);

#endif
