/* discs.h: contracts of the kernels that splat highlights as discs, and occlude these. */
#ifndef RF_KERNELS_DISCS_H
#define RF_KERNELS_DISCS_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/slab.h"

/*
 * draw_disc: to means, rows `first` to end - 1 of a tile, what their pixels see of a run of pixels
 * that is out of focus. Lengths are in 1/64 pixel, of discs of more than 223 pixels in 2^unit / 64
 * pixel, unit 0 to 2, from the middle of the tile's first pixel on. Without a unit, as below too,
 * pixel x of row y sees what lies from 64 x + left[y] to 64 x + right[y], so of the run (from, to)
 * a part as long as v, which gives
 *
 *     mean[c] += round(2^shift w each[c] / 2^15), 65535 in all at most
 *
 * w = v or, with `visible`, floor(v / 2) for each of two masks, one tile of them after the other,
 * that is all 1 there and not 0. 2^shift v and each are below 2^15.
 *
 * half_chords: of a disc of a radius in Q7.8, half of what it is wide, 2^unit / 64 pixel, in rows
 * `first`, half pixels, on from its middle. Or of as many discs one above the other, of rows of a
 * highlight, as it is `tall`, 1 to 4, the mean: of what each is a quarter of a pixel above and
 * below the middle of the row.
 *
 * any_in_slab: whether any of width x height pixels from `blur` on lies in a slab; width: RF_TILE
 * at least.
 *
 * occlude_disc: both masks of `visible` in those rows: not where a slab that is part of the way to
 * the run hides it, where blur, of the tile's first pixel, lies in it at
 *
 *     x + round(step away / 2^23), y + round(step (64 middle - 128 y -+ 32) / 2^23)
 *     away = first + last - 128 x - floor(aside (last - first) / 16) for the one, and
 *            first + last - 128 x + floor((16 - aside) (last - first) / 16) for the other
 *
 * halves up, step = 2^shift times; 64, 128 and 32 are smaller by the unit of the job, 2^23 by that
 * of the way, that of the blurs. The part of the run that the pixel sees goes from first to last:
 * the masks look half of it apart, from aside / 32 of it to the left of its middle on, and a
 * quarter of a row to either side, the first one to the left, or to the right where `mirrored`, and
 * up. Where a pixel sees nothing, both look for the middle of the run as far as it sees: away is
 * from + to - 128 x, at least 2 left and at most 2 right. Without `times` no such product is beyond
 * int16, and no place is farther than `most` to a side, nor than blur is readable. What is found
 * for a row holds for `rows` from it on.
 */
enum { RF_DISC_MOST_UNIT = 2 };
static_assert(64 * (2 * RF_TILE + 2 * 223 + 2 * RF_TILE) <= INT16_MAX,
              "a run and a chord in 1/64 pixel fit 16 bits");
struct rf_disc_job {
    int first, end, shift, planes, unit;
    int16_t left[RF_TILE], right[RF_TILE], from, to, each[3];
    const uint16_t *visible;
};
typedef void rf_draw_disc_fn(uint16_t *const mean[3], const struct rf_disc_job *job);
typedef void rf_half_chords_fn(int16_t half[RF_TILE], int radius, int first, int tall, int unit);
struct rf_disc_way {
    int shift, rows, most, unit;
    int middle; /* half pixels */
    int aside;  /* 1 to 15 */
    bool mirrored;
    int16_t times;
};
typedef bool rf_any_in_slab_fn(const int16_t *blur, ptrdiff_t stride, int width, int height,
                               const struct rf_slab *slab);
typedef void rf_occlude_disc_fn(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
                                const struct rf_slab *slab, const struct rf_disc_job *job,
                                const struct rf_disc_way *way);

#endif
