/* background.h: contracts of the kernels that mark the hidden background and inpaint it by
 * push-pull. */
#ifndef RF_KERNELS_BACKGROUND_H
#define RF_KERNELS_BACKGROUND_H

#include <assert.h>
#include "colour/transfer.h"
#include <stddef.h>
#include <stdint.h>

/* The cone of the background mark falls by half a pixel a pixel; Q7.8. Blurs of a unit are in
 * 2^unit pixels, and falls so much less, half up. */
enum { RF_CONE_STEP = 128, RF_CONE_DIAGONAL = 181 };
static inline int rf_cone_fall(int fall, int unit)
{
    return (fall + (1 << unit >> 1)) >> unit;
}
static_assert(RF_CONE_DIAGONAL * RF_CONE_DIAGONAL < 2 * RF_CONE_STEP * RF_CONE_STEP &&
                  (2 * RF_CONE_DIAGONAL + 1) * (2 * RF_CONE_DIAGONAL + 1) >
                      8 * RF_CONE_STEP * RF_CONE_STEP,
              "a diagonal step is the straight one times the root of 2, rounded");

/* Unknown pixels of the background have this blur, which no known one has. */
enum { RF_NO_BLUR = INT16_MIN };

/* The lowest bit of a blur in the pyramid: push clears it in parents, of which something is known,
 * and pull sets it in what it inpaints. Blurs that differ in it alone are those of one surface. */
enum { RF_INPAINTED = 1 };

/*
 * spread_row: grey dilation of a row by the cone to both sides, of values at most
 * `reach` cone steps apart, reach at most 2 M - 1, M = rf_spread_margin(unit). Values are s +
 * 2^15. Returns where the result is, row or spare; both are n long, with M elements before and
 * after them that are overwritten.
 */
static inline int rf_spread_margin(int unit)
{
    return 256 << unit;
}
typedef uint16_t *rf_spread_row_fn(uint16_t *row, uint16_t *spare, int reach, int unit, int n);

/* dilate_from: the cone from the three nearest pixels of the row before or after, whose
 * elements -1 and n are read. Values are s + 2^15. */
typedef void rf_dilate_from_fn(uint16_t *row, const uint16_t *before, int unit, int n);

/* mark_foreground: the blur of pixels that are not foreground, RF_NO_BLUR of those whose dilated
 * value is above their own. `dilated` is s + 2^15. */
typedef void rf_mark_foreground_fn(int16_t *background_blur, const int16_t *blur,
                                   const uint16_t *dilated, int n);

/* push: n parents of 2 x 2 children: the mean of the known ones, half up, and their farthest blur
 * without its lowest bit; 0 and RF_NO_BLUR if none is known. Those that are more than `apart` in
 * front of the farthest do not count, none with INT16_MAX. */
static_assert(4 * 4 * RF_LIGHT_MAX + 2 <= UINT16_MAX, "four children of push fit 16 bits");
typedef void rf_push_fn(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
                        const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1,
                        int16_t apart, int n);

/*
 * pull: unknown ones of 2 x pairs children take 3 and 1 quarters of the nearest parents, down and
 * then across, each half up. Of two parents whose blurs are more than `apart` apart, the deeper
 * one counts alone unless the other one is inpainted; with INT16_MAX none is. pull_blur: they take
 * the nearest parent's blur, or such a deeper one, and RF_INPAINTED. Each row of `mixed` is scratch
 * of pairs + 2.
 *
 * An example with `apart` 1280: parents of light 100 and 900 and of blurs -5120 and 0 make a child
 * of light 900 and blur 1, of blurs -5119 and 0 one of 300 and 1, and of blurs -1024 and 0 one of
 * 300 and -1023.
 */
static_assert((3 + 1) * 4 * RF_LIGHT_MAX + 2 <= UINT16_MAX, "a sum of pull fits 16 bits");
struct rf_parents {
    const uint16_t *near_light, *far_light;
    const int16_t *near_blur, *far_blur;
    int16_t apart;
};
struct rf_mixed_parents {
    uint16_t *light;
    int16_t *blur;
};
typedef void rf_pull_fn(uint16_t *out, const int16_t *out_blur, const struct rf_parents *parents,
                        struct rf_mixed_parents mixed, int pairs);
typedef void rf_pull_blur_fn(int16_t *out, const struct rf_parents *parents, int16_t *mixed,
                             int pairs);

/* push1: push, of one plane. */
typedef void rf_push1_fn(uint16_t *out, int16_t *out_blur, const uint16_t *upper,
                         const uint16_t *lower, const int16_t *blur0, const int16_t *blur1,
                         int16_t apart, int n);

/* split2: n means of two rows of pairs, half up, the firsts and the seconds apart.
 * join2: pairs of them again.
 * restore_known2: n pairs become `own` where neither of the two pixels of the background is
 * unknown.
 */
typedef void rf_split2_fn(uint16_t *first, uint16_t *second, const uint16_t *upper,
                          const uint16_t *lower, int n);
typedef void rf_join2_fn(uint16_t *out, const uint16_t *first, const uint16_t *second, int n);
typedef void rf_restore_known2_fn(uint16_t *out, const uint16_t *own,
                                  const int16_t *background_blur, int n);

/* products: the sum of the products of n x rows elements of two rectangles whose rows are `stride`
 * apart; n times the largest product fits 31 bits. */
typedef int64_t rf_products_fn(const int16_t *a, const int16_t *b, ptrdiff_t stride, int n,
                               int rows);

/*
 * solve_lanes: solves n equations with n unknowns, A x = b, in each of RF_SOLVE_LANES lanes. A is
 * symmetric, positive definite but for rounding, and given by the rows of its lower triangle, one
 * after the other; it is overwritten. x is b before. A = L D L^T; no pivot is taken to be less than
 * 1 / RF_SOLVE_PIVOT of the element of A in its place. Every operation is rounded to float alone,
 * in the order of the reference, so that all instruction sets yield the same bits.
 */
enum { RF_SOLVE_LANES = 8, RF_SOLVE_PIVOT = 32 };
typedef void rf_solve_lanes_fn(float (*matrix)[RF_SOLVE_LANES], float (*x)[RF_SOLVE_LANES], int n);

#endif
