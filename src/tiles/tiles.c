/* tiles.c: notes the blurs of each tile, and covers those that can reach it by slabs. */
#include "tiles/tiles.h"

#include <assert.h>
#include <stdlib.h>

#include "colour/transfer.h"
#include "support/compare.h"
#include "tiles/scale.h"

enum { EACH = RF_TILE / RF_CELL }; /* cells of a tile, across and down */

enum {
    HALF = 128,           /* 1/256 pixel, as all of these */
    OVERLAP = 32,         /* a slab reaches so far into each of those beside it */
    CLOSED = 2 * OVERLAP, /* so that the slab of what is sharp overlaps them as much in all */
    WIDE = 16 * 256,      /* where slabs begin to be wider than a pixel */
    MOST_SPREAD = 60416,  /* blurs within it hit no slab of up to 20 pixels modulo 2^16 */
};

/* The widest slab begins in the first bin of whole pixels. In bins of whole pixels; it is cut to
 * them before it is widened by an eighth on each side. */
enum { LARGEST = RF_PLAIN_RADIUS * 256, WIDEST = (2 * (LARGEST + HALF) - WIDE) / WIDE };
static_assert(WIDEST * 256 * 5 / 4 <= 20 * 256, "no slab is wider than 20 pixels");
static_assert(MOST_SPREAD + 20 * 256 <= UINT16_MAX + 1, "told apart modulo 2^16");

static_assert(2 * RF_UNIT_RADIUS * 256 <= MOST_SPREAD && RF_UNIT_RADIUS << RF_MAX_UNIT < 1024 &&
                  RF_FINE + 5 * RF_OCTAVE <= 127,
              "blurs with a unit have few bins, and slabs of any width");

struct rf_bin_scale rf_bin_scale_of(float largest_blur, int unit)
{
    const int shift = unit || largest_blur > 63.5f ? 8 : largest_blur <= 31.5f ? 6 : 7;

    /* So -31.5 .. 31.5 pixels are bins 3 .. 255 at shift 6, -63.5 .. 63.5 bins 1 .. 255 at
     * shift 7, -127 .. 127 bins 0 .. 254 at shift 8. */
    static_assert(((63 * 128 + HALF) >> 6) + 127 < RF_BINS, "bins of 31.5 pixels at shift 6");
    static_assert(((127 * 128 + HALF) >> 7) + 127 < RF_BINS, "bins of 63.5 pixels at shift 7");
    static_assert(((LARGEST + HALF) >> 8) + 127 < RF_BINS, "bins of 127 pixels at shift 8");
    static_assert((LARGEST - HALF) / 256 < 127, "the nearest blur has no bin below 0");
    static_assert(2 * 127 * 128 < 1 << 15, "blurs of up to 63.5 pixels or units differ by less");
    return (struct rf_bin_scale){shift, 127, 256 >> shift, unit,
                                 largest_blur <= 63.5f * (float)(1 << unit)};
}

static void add_bin(struct rf_bins *bins, int bin)
{
    bins->word[bin / 64] |= UINT64_C(1) << bin % 64;
}

/* Adds the blurs of a cell whose extremes are not in one bin. */
static void add_cell(struct rf_bins *bins, struct rf_bin_scale scale, const int16_t *s,
                     ptrdiff_t stride, int first, int last)
{
    uint64_t found = 0; /* from `first` on */

    for (int i = 0; i < RF_CELL * RF_CELL; i++) {
        const int bin = rf_bin_of(scale, s[i / RF_CELL * stride + i % RF_CELL]);

        if (last - first < 64)
            found |= UINT64_C(1) << (bin - first);
        else
            add_bin(bins, bin);
    }
    bins->word[first / 64] |= found << first % 64;
    if (first % 64 && first / 64 + 1 < RF_BINS / 64)
        bins->word[first / 64 + 1] |= found >> (64 - first % 64);
}

/* Adds the blurs of a tile's cells, pixel by pixel where a cell may have more than two bins. */
static void add_cells(struct rf_bins *bins, struct rf_bin_scale scale, struct rf_blur_q8 blur,
                      const struct rf_cells *cells, int tx, int ty)
{
    for (int y = ty * EACH; y < (ty + 1) * EACH; y++) {
        const int16_t *least = cells->least + y * cells->stride;
        const int16_t *most = cells->most + y * cells->stride;

        for (int x = tx * EACH; x < (tx + 1) * EACH; x++) {
            const int first = rf_bin_of(scale, least[x]), last = rf_bin_of(scale, most[x]);

            add_bin(bins, first);
            add_bin(bins, last);
            if (last - first > 1)
                add_cell(bins, scale, blur.at + RF_CELL * (y * blur.stride + x), blur.stride, first,
                         last);
        }
    }
}

static struct rf_bins bins_of_tile(struct rf_bin_scale scale, struct rf_blur_q8 blur,
                                   const struct rf_cells *cells, int tx, int ty)
{
    struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN, .brightest = RF_LIGHT_MAX};
    int first, last;

    for (int y = ty * EACH; y < (ty + 1) * EACH; y++) {
        const int16_t *least = cells->least + y * cells->stride + tx * EACH;
        const int16_t *most = cells->most + y * cells->stride + tx * EACH;

        for (int x = 0; x < EACH; x++) {
            bins.least = least[x] < bins.least ? least[x] : bins.least;
            bins.most = most[x] > bins.most ? most[x] : bins.most;
        }
    }
    first = rf_bin_of(scale, bins.least);
    last = rf_bin_of(scale, bins.most);
    add_bin(&bins, first);
    add_bin(&bins, last);
    if (last - first > 1)
        add_cells(&bins, scale, blur, cells, tx, ty);
    return bins;
}

void rf_bin_tiles(const struct rf_viewport *view, struct rf_bin_scale scale, struct rf_blur_q8 blur,
                  const struct rf_cells *cells, struct rf_bins *bins, int ty)
{
    for (int tx = 0; tx < view->tiles_x; tx++)
        bins[(size_t)ty * view->tiles_x + tx] = bins_of_tile(scale, blur, cells, tx, ty);
}

void rf_add_bin(const struct rf_viewport *view, struct rf_bins *bins, struct rf_bin_scale scale,
                int x, int y, int16_t blur)
{
    struct rf_bins *tile = &bins[(size_t)(y / RF_TILE) * view->tiles_x + x / RF_TILE];

    add_bin(tile, rf_bin_of(scale, blur));
    tile->least = blur < tile->least ? blur : tile->least;
    tile->most = blur > tile->most ? blur : tile->most;
}

void rf_note_background_blur(const struct rf_viewport *view, struct rf_blur_q8 background_blur,
                             struct rf_bins *bins, int ty)
{
    const int16_t *row = background_blur.at + (ty * RF_TILE + RF_TILE / 2) * background_blur.stride;

    for (int tx = 0; tx < view->tiles_x; tx++)
        bins[(size_t)ty * view->tiles_x + tx].background_blur = row[tx * RF_TILE + RF_TILE / 2];
}

static bool has(const struct rf_bins *bins, int bin)
{
    return bins->word[bin / 64] >> (bin % 64) & 1;
}

/* The first bin from `bin` on that is occupied, RF_BINS if none is. */
static int next_bin(const struct rf_bins *bins, int bin)
{
    for (; bin < RF_BINS; bin = (bin / 64 + 1) * 64)
        if (bins->word[bin / 64] >> bin % 64)
            return bin + __builtin_ctzll(bins->word[bin / 64] >> bin % 64);
    return RF_BINS;
}

/* Where blurs differ by less than 2^15, a range of any width is told from what lies outside modulo
 * 2^16; else one slab is as much as can be. */
static void add_slab(struct rf_tile_plan *plan, struct rf_bin_scale scale, struct rf_slab slab)
{
    const int k = plan->slabs++;

    plan->slab[k] = slab;
    plan->joined[k] =
        k > 0 && scale.joins && slab.low <= plan->slab[k - 1].low + plan->slab[k - 1].width + 1;
}

/* Where a slab that begins with that bin ends, about as wide as one of blurs without a unit. */
static int end_with_unit(struct rf_bin_scale scale, int bin)
{
    const int low = rf_edge_of(scale, bin), pixel = 256 >> scale.unit;
    const int until = low + abs(low) / 8 - pixel;
    int end = rf_bin_of(scale, until);

    if (2 * until >
        rf_edge_of(scale, end) + rf_edge_of(scale, end + 1)) /* the next edge is nearer to it */
        end++;
    return rf_larger(end, bin + 1);
}

/* Where a slab ends that begins with that bin; `wide` ones may be. */
static int end_of(struct rf_bin_scale scale, int bin, bool wide)
{
    const int pixel = 256 >> scale.shift, low = rf_edge_of(scale, bin);
    int end = bin + pixel;

    if (bin >= scale.focus && bin < scale.focus + scale.focus_bins)
        return scale.focus + scale.focus_bins;
    if (scale.unit)
        end = end_with_unit(scale, bin);
    else if (wide && abs(low) >= WIDE)
        end = bin + (int)((int64_t)pixel * (2 * abs(low) - WIDE) / WIDE);
    else if (pixel > 1 && low > -3 * 256 && low < 3 * 256)
        end = bin + pixel / 2;
    return bin < scale.focus && end > scale.focus ? scale.focus : end;
}

/* Covers the occupied bins by slabs, nearest first. Slabs are a pixel wide, half of that where the
 * blur is small and a pixel would show, and |s| / 8 less one pixel from 16 pixels on: there rays
 * lie farther apart than half of that. Wide slabs end where those end that cover all bins from the
 * nearest on, so that all tiles take the same blurs for one: what is in one slab does not occlude
 * each other, and where tiles differed in that, their edges would show.
 *
 * The blurs below half a pixel are a slab of their own with offset 0, so that these pixels stay as
 * they are. No slab before it may hold them, as its rays would bring light from beside them. Yet no
 * ray may pass between two slabs where a surface crosses half a pixel of blur. So the sharp slab
 * reaches into the nearer blurs by CLOSED, which the slabs before it leave out; and the slab after
 * it reaches as far into the sharp blurs, for rays of pixels that are blurred. With 1/4 pixel
 * surfaces of slope up to 1/4 have no gaps: a ray of a pixel of blur 0.60 that looks at its
 * neighbour of blur 0.45 hits it. Without the overlap it would miss that, and itself at offset 0.
 */
static void cover(const struct rf_bins *bins, struct rf_bin_scale scale, struct rf_tile_plan *plan)
{
    const int unit = scale.unit, half = HALF >> unit, closed = CLOSED >> unit;
    const int focus_end = scale.focus + scale.focus_bins;
    const bool wide = bins->most - bins->least < MOST_SPREAD;
    int cell = 0; /* the slab that `bin` is in, of those that cover all bins: where it begins */

    plan->slabs = 0;
    plan->reach = 0;
    plan->least = INT16_MAX;
    plan->sharp = true;
    for (int bin = next_bin(bins, 0); bin < RF_BINS; bin = next_bin(bins, bin)) {
        int end, last = bin, low, high, centre, overlap;

        if (bin >= scale.focus && bin < focus_end) {
            add_slab(
                plan, scale,
                (struct rf_slab){(int16_t)(-half - closed), (uint16_t)(2 * half + closed - 1), 0});
            plan->least = 0;
            bin = focus_end;
            continue;
        }
        low = rf_edge_of(scale, bin);
        while ((end = end_of(scale, cell, wide)) <= bin)
            cell = end;
        if (!unit && abs(low) < WIDE)
            end = end_of(scale, bin, false);
        for (int b = bin; b < end && b < RF_BINS; b++)
            if (has(bins, b))
                last = b;
        high = rf_edge_of(scale, last + 1) - 1;
        low = low < bins->least ? bins->least : low;
        high = high > bins->most ? bins->most : high;
        centre = low + (high - low + 1) / 2; /* exact for a single blur */
        plan->sharp = false;
        if (-low > plan->reach)
            plan->reach = -low;
        if (high > plan->reach)
            plan->reach = high;
        if (low > 0 && low < plan->least)
            plan->least = low;
        if (high < 0 && -high < plan->least)
            plan->least = -high;
        overlap = rf_larger(OVERLAP >> unit, (high - low) / 8);
        low -= overlap;
        high += overlap;
        if (centre < 0 && high >= -half)
            high = -half - 1;
        if (centre > 0 && low < half)
            low = half - closed;
        add_slab(plan, scale,
                 (struct rf_slab){(int16_t)low, (uint16_t)(high - low), (int16_t)centre});
        bin = last + 1;
    }
    plan->reach = rf_in_pixels(plan->reach, unit);
    plan->least = rf_in_pixels(plan->least, unit);
}

void rf_plan_tile(const struct rf_viewport *view, const struct rf_bins *bins,
                  const struct rf_reach *reach, int tx, int ty, struct rf_tile_plan *plan)
{
    const struct rf_bins in_reach = rf_collect(view, bins, reach, tx, ty);

    cover(&in_reach, reach->scale, plan);
    plan->highlight = rf_in_pixels(in_reach.highlight, reach->scale.unit);
    plan->undersampled = in_reach.undersampled > 0;
    plan->brightest = in_reach.brightest;
}
