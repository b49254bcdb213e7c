/* slabs.c: covers the blurs that can reach a tile by slabs. */
#include "tiles/tiles.h"

#include <assert.h>
#include <stdlib.h>

#include "support/compare.h"
#include "tiles/scale.h"
#include "tiles/surfaces.h"

enum {
    HALF = 128,            /* 1/256 pixel, as all of these */
    OVERLAP = 32,          /* a slab reaches so far into each of those beside it */
    CLOSED = 2 * OVERLAP,  /* so that the slab of what is sharp overlaps them as much in all */
    STEEP = 192,           /* a slab of a steep surface reaches so far into the nearer one */
    MOST_STEEP = 16 * 256, /* up to this blur slabs of steep surfaces reach farther */
    CRACKED = 2 * 256,     /* up to this blur cracks between slabs are closed */
    MOST_NOISY = 8 * 256,  /* by this, at the most, noise widens the slab that closes a crack */
    CLOSABLE = 12 * 256,   /* two slabs that are wider together are surfaces of much noise */
    WIDE = 16 * 256,       /* where slabs begin to be wider than a pixel */
    MOST_SPREAD = 60416,   /* blurs within it hit no slab of up to 20 pixels modulo 2^16 */
};

/* The widest slab begins in the first bin of whole pixels. In bins of whole pixels; it is cut to
 * them before it is widened by an eighth on each side. */
enum { LARGEST = RF_PLAIN_RADIUS * 256, WIDEST = (2 * (LARGEST + HALF) - WIDE) / WIDE };
static_assert(WIDEST * 256 * 5 / 4 <= 20 * 256, "no slab is wider than 20 pixels");
static_assert(CLOSABLE + MOST_NOISY <= 20 * 256, "nor is one of two");
static_assert(MOST_SPREAD + 20 * 256 <= UINT16_MAX + 1, "told apart modulo 2^16");

static_assert(2 * RF_UNIT_RADIUS * 256 <= MOST_SPREAD && RF_UNIT_RADIUS << RF_MAX_UNIT < 1024 &&
                  RF_FINE + 5 * RF_OCTAVE <= 127,
              "blurs with a unit have few bins, and slabs of any width");

/* How slabs of noise are merged. */
enum {
    NOISY_SLABS = 8, /* slabs of noise alone; then they grow, up to LARGEST_RATIO */
    LARGEST_RATIO = 8,
};

/* How slabs are merged. */
struct merging {
    int noise; /* so wide are slabs of noise at the most */
    int ratio; /* the far side of one is at most 1 + ratio times as far out of focus as the near one
                */
    int widest;                        /* widest_slab() */
    struct rf_level_surfaces surfaces; /* each is a slab */
};

static bool has(const uint64_t word[RF_BINS / 64], int bin)
{
    return word[bin / 64] >> (bin % 64) & 1;
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
 * 2^16; else one slab is as much as can be. A range begins where the former slab does. */
static void add_slab(struct rf_tile_plan *plan, struct rf_bin_scale scale, struct rf_slab slab)
{
    const int k = plan->slabs++;
    const struct rf_slab *const before = &plan->slab[k ? k - 1 : 0];

    plan->slab[k] = slab;
    plan->joined[k] = k > 0 && scale.joins && slab.low >= before->low &&
                      slab.low <= before->low + before->width + 1;
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

void rf_slab_ends(struct rf_bin_scale scale, bool wide, uint16_t end[RF_BINS])
{
    for (int bin = 0, next = 0; bin < RF_BINS; bin++) {
        if (bin == next)
            next = end_of(scale, bin, wide);
        end[bin] = (uint16_t)next;
    }
}

/* Where a slab ends that begins with that bin and would end with `end`, if what follows is noise
 * too. A gap as wide as that slab ends it. */
static int end_of_noise(const struct rf_bins_in_reach *reach, struct rf_bin_scale scale,
                        const struct merging *merging, int bin, int end)
{
    const int low = rf_edge_of(scale, bin), ratio = merging->ratio, most_gap = end - bin;
    const int farthest = low < 0 ? -low / (1 + ratio) * ratio : low * ratio;
    const int width = rf_smaller(rf_smaller(merging->noise, merging->widest), farthest);
    int until = rf_smaller(rf_bin_of(scale, low + width), RF_BINS), gap = 0;

    if (bin < scale.focus && until > scale.focus)
        until = scale.focus;
    for (int b = bin; b < until; b++) {
        gap = has(reach->all.word, b) ? 0 : gap + 1;
        if (has(reach->sure, b) || gap >= most_gap)
            return rf_larger(b, end);
    }
    return rf_larger(until, end);
}

/* Whether a steep surface may have blurs in bins first to end - 1, which are a slab. */
static bool is_steep(const struct rf_bins_in_reach *in_reach, struct rf_bin_scale scale, int first,
                     int end)
{
    if (!in_reach->all.steep || abs(rf_edge_of(scale, first)) > MOST_STEEP >> scale.unit)
        return false;
    for (int bin = first; bin < end && bin < RF_BINS; bin++)
        if (has(in_reach->steep, bin))
            return true;
    return false;
}

/* Adds a slab of the blurs low to high, none of which is sharp, that overlaps those beside it. */
static void add_blurred_slab(struct rf_tile_plan *plan, struct rf_bin_scale scale, int low,
                             int high, bool steep)
{
    const int half = HALF >> scale.unit, closed = CLOSED >> scale.unit;
    const int centre = low + (high - low + 1) / 2; /* exact for a single blur */
    const int overlap = rf_larger(OVERLAP >> scale.unit, (high - low) / 8);
    const int nearer = rf_larger((steep ? STEEP : OVERLAP) >> scale.unit, overlap);

    plan->sharp = false;
    plan->reach = rf_larger(plan->reach, rf_larger(-low, high));
    if (low > 0 && low < plan->least)
        plan->least = low;
    if (high < 0 && -high < plan->least)
        plan->least = -high;
    low = rf_larger(low - nearer, INT16_MIN);
    high = rf_smaller(high + overlap, INT16_MAX);
    if (centre < 0 && high >= -half)
        high = -half - 1;
    if (centre > 0 && low < half && !steep)
        low = half - closed;
    add_slab(plan, scale, (struct rf_slab){(int16_t)low, (uint16_t)(high - low), (int16_t)centre});
}

/* Adds the slab of a surface, which is seen in its middle: it is sharp there below half a pixel. It
 * reaches into what is nearer by half of its noise at least: where two surfaces meet, a ray passes
 * the nearer one at pixels whose noise is of the other. */
static void add_surface(struct rf_tile_plan *plan, struct rf_bin_scale scale,
                        const struct rf_level_surface *surface)
{
    const int centre = abs(surface->middle) < HALF >> scale.unit ? 0 : surface->middle;
    int low = rf_edge_of(scale, surface->first), high = rf_edge_of(scale, surface->end) - 1;
    const int overlap = rf_larger(OVERLAP >> scale.unit, (high - low) / 8);

    plan->sharp = plan->sharp && centre == 0;
    plan->reach = rf_larger(plan->reach, abs(centre));
    plan->least = rf_smaller(plan->least, abs(centre));
    low = rf_larger(low - rf_larger(overlap, surface->noise / 2), INT16_MIN);
    high = rf_smaller(high + overlap, INT16_MAX);
    add_slab(plan, scale, (struct rf_slab){(int16_t)low, (uint16_t)(high - low), (int16_t)centre});
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
 *
 * Where surfaces are steeper, as in soft maps, slabs overlap by 7/8 pixel: else bright fragments of
 * the hidden background show on them. Most of that is the deeper slab's, which is tested after the
 * nearer one, so that it takes no ray that hits its own slab.
 *
 * Returns how many of the slabs are of noise.
 */
static int cover(const struct rf_bins_in_reach *in_reach, const struct rf_reach *reach,
                 const struct merging *merging, struct rf_tile_plan *plan)
{
    const struct rf_bins *const bins = &in_reach->all;
    const struct rf_bin_scale scale = reach->scale;
    const int unit = scale.unit, half = HALF >> unit;
    const int focus_end = scale.focus + scale.focus_bins;
    const uint16_t *const end_of_wide = reach->slab_end[bins->most - bins->least < MOST_SPREAD];
    int noisy = 0, next = 0; /* surface */

    plan->slabs = 0;
    plan->reach = 0;
    plan->least = INT16_MAX;
    plan->sharp = true;
    for (int bin = next_bin(bins, 0); bin < RF_BINS; bin = next_bin(bins, bin)) {
        int end, last = bin, low, high;
        bool sure = false;

        while (next < merging->surfaces.count && bin >= merging->surfaces.at[next].end)
            next++;
        if (next < merging->surfaces.count && bin >= merging->surfaces.at[next].first) {
            add_surface(plan, scale, &merging->surfaces.at[next]);
            bin = merging->surfaces.at[next].end;
            continue;
        }
        if (bin >= scale.focus && bin < focus_end) {
            const bool steep = is_steep(in_reach, scale, bin, focus_end);
            const int closed = (steep ? OVERLAP + STEEP : CLOSED) >> unit;

            add_slab(
                plan, scale,
                (struct rf_slab){(int16_t)(-half - closed), (uint16_t)(2 * half + closed - 1), 0});
            plan->least = 0;
            bin = focus_end;
            continue;
        }
        low = rf_edge_of(scale, bin);
        end = unit || abs(low) >= WIDE ? end_of_wide[bin] : end_of(scale, bin, false);
        if (merging->noise)
            end = end_of_noise(in_reach, scale, merging, bin, end);
        if (next < merging->surfaces.count)
            end = rf_smaller(end, merging->surfaces.at[next].first);
        for (int b = bin; b < end && b < RF_BINS; b++) {
            if (has(bins->word, b))
                last = b;
            sure = sure || has(in_reach->sure, b);
        }
        noisy += !sure;
        high = rf_edge_of(scale, last + 1) - 1;
        low = low < bins->least ? bins->least : low;
        high = high > bins->most ? bins->most : high;
        add_blurred_slab(plan, scale, low, high, is_steep(in_reach, scale, bin, last + 1));
        bin = last + 1;
    }
    plan->reach = rf_in_pixels(plan->reach, unit);
    plan->least = rf_in_pixels(plan->least, unit);
    return noisy;
}

/* Blurs within the tile hit no wider slab modulo 2^16, with what it overlaps. */
static int widest_slab(const struct rf_bins_in_reach *in_reach)
{
    return (UINT16_MAX + 1 - (in_reach->all.most - in_reach->all.least)) / 5 * 4 - OVERLAP - STEEP;
}

/* Covers the occupied bins: where they are noise, by as few slabs as a tile may have. Others are
 * never merged for their number, which the growing width of slabs bounds: tiles beside each other
 * would differ in what occludes what. */
static void cover_bounded(const struct rf_bins_in_reach *in_reach, const struct rf_reach *reach,
                          const struct rf_level_surfaces *surfaces, struct rf_tile_plan *plan)
{
    const int noise = in_reach->noisy ? (int)(in_reach->noise / in_reach->noisy) : 0;
    struct merging merging = {.noise = rf_smaller(RF_NOISE_TIMES * noise, INT16_MAX),
                              .ratio = 1,
                              .widest = widest_slab(in_reach),
                              .surfaces = *surfaces};
    int noisy;

    plan->noise = rf_in_pixels(noise, reach->scale.unit);
    noisy = cover(in_reach, reach, &merging, plan);
    while (noisy > NOISY_SLABS && merging.ratio < LARGEST_RATIO) {
        merging.ratio *= 2;
        noisy = cover(in_reach, reach, &merging, plan);
    }
}

/* Whether a ray may pass a surface between slab k, which is not the deepest, and the one before it.
 */
static bool has_crack(const struct rf_tile_plan *plan, int k, int unit)
{
    const struct rf_slab *const slab = &plan->slab[k], *const before = slab - 1;

    return k > 0 && k < plan->slabs - 1 && abs(slab->centre) <= CRACKED >> unit &&
           slab->low <= before->low + before->width &&
           slab->low + slab->width - before->low <= CLOSABLE;
}

/* The blurs of slab k and of the one before it, seen in the middle between them. Noise takes a
 * pixel nearer than that. What is deeper is left to the slab after it: it would be seen with half
 * of its blur. */
static struct rf_slab closing_slab(const struct rf_tile_plan *plan, int k, int noise)
{
    const struct rf_slab *const slab = &plan->slab[k], *const before = slab - 1;
    const int more = rf_smaller(noise / 4, MOST_NOISY);

    return (struct rf_slab){
        (int16_t)(before->low - more),
        (uint16_t)(slab->low + slab->width - before->low + more),
        (int16_t)((before->low + before->width + slab->low) >> 1),
    };
}

/* Closes the cracks between slabs of noise near the focus. Where the blurs of a pixel and of its
 * neighbour are in two slabs, a ray that looks for each in the place of the other passes the
 * surface, and one bright pixel of the background shows in a subject in focus. Such a ray looks
 * once more, in the middle between both, for the blurs of either. Farther out of focus such dots do
 * not show. */
static void close_cracks(struct rf_tile_plan *plan, int unit)
{
    const int slabs = plan->slabs, noise = plan->noise >> unit;
    int cracks = 0;

    for (int k = 1; k < slabs; k++)
        cracks += has_crack(plan, k, unit);
    for (int k = slabs - 1; cracks; k--) {
        if (has_crack(plan, k, unit)) {
            plan->slab[k + cracks] = closing_slab(plan, k, noise);
            plan->joined[k + cracks] = false;
            cracks--;
            plan->slabs++;
        }
        plan->slab[k + cracks] = plan->slab[k];
        plan->joined[k + cracks] = plan->joined[k];
    }
}

void rf_plan_tile(const struct rf_viewport *view, const struct rf_bins *bins,
                  const struct rf_reach *reach, int tx, int ty, struct rf_tile_plan *plan)
{
    const struct rf_bins_in_reach in_reach = rf_collect(view, bins, reach, tx, ty);
    struct rf_level_surfaces surfaces;

    rf_find_surfaces(view, bins, &in_reach, reach->scale, tx, ty, widest_slab(&in_reach),
                     &surfaces);
    cover_bounded(&in_reach, reach, &surfaces, plan);
    if (plan->noise > 0 && in_reach.all.most - in_reach.all.least < MOST_SPREAD)
        close_cracks(plan, reach->scale.unit);
    plan->highlight = rf_in_pixels(in_reach.all.highlight, reach->scale.unit);
    plan->undersampled = in_reach.all.undersampled > 0;
    plan->brightest = in_reach.all.brightest;
}
