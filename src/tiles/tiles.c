#include "tiles/tiles.h"

#include <string.h>

enum { HALF = 128, OVERLAP = 32 }; /* Q7.8 pixels */

struct rf_bin_scale rf_bin_scale_of(float max_blur_radius)
{
    const int shift = max_blur_radius <= 31.5f ? 6 : max_blur_radius <= 63.5f ? 7 : 8;

    /* Then -31.5 .. 31.5 pixels are bins 3 .. 255 at shift 6, -63.5 .. 63.5 bins 1 .. 255 at
     * shift 7, -127 .. 127 bins 0 .. 254 at shift 8. */
    return (struct rf_bin_scale){shift, 127, 256 >> shift};
}

static int bin_of(struct rf_bin_scale scale, int s)
{
    return ((s + HALF) >> scale.shift) + scale.focus;
}

/* Least blur of a bin. */
static int edge_of(struct rf_bin_scale scale, int bin)
{
    return (bin - scale.focus) * (1 << scale.shift) - HALF;
}

/* Flags of bins, a byte each, to bits. */
static struct rf_bins pack(const uint8_t flag[RF_BINS])
{
    struct rf_bins bins = {.word = {0}};

    for (int i = 0; i < RF_BINS; i++)
        bins.word[i / 64] |= (uint64_t)flag[i] << (i % 64);
    return bins;
}

void rf_bin_tiles(struct refocus_renderer *r, struct rf_bin_scale scale, int ty)
{
    const int y1 = (ty + 1) * RF_TILE < r->height ? (ty + 1) * RF_TILE : r->height;

    for (int tx = 0; tx < r->tiles_x; tx++) {
        struct rf_bins *bins = &r->bins[(size_t)ty * r->tiles_x + tx];
        const ptrdiff_t x0 = (ptrdiff_t)tx * RF_TILE; /* the border repeats the last pixel */
        int16_t least = INT16_MAX, most = INT16_MIN;
        uint8_t flag[RF_BINS] = {0};

        for (int y = ty * RF_TILE; y < y1; y++) {
            const int16_t *s = r->front.blur + y * r->stride + x0;

            for (int x = 0; x < RF_TILE; x++) {
                least = s[x] < least ? s[x] : least;
                most = s[x] > most ? s[x] : most;
            }
        }
        if (bin_of(scale, least) == bin_of(scale, most)) {
            memset(bins, 0, sizeof *bins);
            bins->word[bin_of(scale, least) / 64] = UINT64_C(1) << bin_of(scale, least) % 64;
        } else {
            for (int y = ty * RF_TILE; y < y1; y++) {
                const int16_t *s = r->front.blur + y * r->stride + x0;

                for (int x = 0; x < RF_TILE; x++)
                    flag[bin_of(scale, s[x])] = 1;
            }
            *bins = pack(flag);
        }
        bins->least = least;
        bins->most = most;
        bins->lamp = 0;
    }
}

void rf_add_bin(struct refocus_renderer *r, struct rf_bin_scale scale, int tx, int ty,
                int16_t blur)
{
    struct rf_bins *bins = &r->bins[(size_t)ty * r->tiles_x + tx];
    const int bin = bin_of(scale, blur);

    bins->word[bin / 64] |= UINT64_C(1) << bin % 64;
    bins->least = blur < bins->least ? blur : bins->least;
    bins->most = blur > bins->most ? blur : bins->most;
}

static bool has(const struct rf_bins *bins, int bin)
{
    return bins->word[bin / 64] >> (bin % 64) & 1;
}

/* Clear bins [from, to). */
static void clear(struct rf_bins *bins, int from, int to)
{
    for (int i = 0; i < RF_BINS / 64; i++) {
        const int a = from - 64 * i < 0 ? 0 : from - 64 * i;
        const int b = to - 64 * i > 64 ? 64 : to - 64 * i;

        if (a < b)
            bins->word[i] &= ~((b - a == 64 ? ~UINT64_C(0) : (UINT64_C(1) << (b - a)) - 1)
                               << a);
    }
}

/* Pixels between tiles that are n tiles apart: those side by side are one pixel apart. */
static int gap_of(int n)
{
    n = n < 0 ? -n : n;
    return n ? (n - 1) * RF_TILE + 1 : 0;
}

/* Drop the bins of blurs below s: a pixel g away is met only if |s| >= g - 1. */
static void drop_short(struct rf_bins *bins, struct rf_bin_scale scale, int s)
{
    const int first = bin_of(scale, -s + (1 << scale.shift)), end = bin_of(scale, s);
    const int low = edge_of(scale, first), high = edge_of(scale, end);

    clear(bins, first, end);
    if (bins->least >= low && bins->least < high)
        bins->least = (int16_t)high;
    if (bins->most >= low && bins->most < high)
        bins->most = (int16_t)(low - 1);
}

/* Bins that reach tile (tx, ty) and all bins that stand in the window around it. */
static void collect(const struct refocus_renderer *r, struct rf_bin_scale scale, int tx,
                    int ty, bool square, struct rf_bins *reach, struct rf_bins *window)
{
    const int most = (r->pad - 2 + RF_TILE - 1) / RF_TILE;

    *reach = *window = (struct rf_bins){{0}, INT16_MAX, INT16_MIN, 0, 0};
    for (int j = -most; j <= most; j++) {
        if (ty + j < 0 || ty + j >= r->tiles_y)
            continue;
        for (int i = -most; i <= most; i++) {
            const int gx = gap_of(i), gy = gap_of(j);
            struct rf_bins bins;
            int least = gx > gy ? gx : gy;

            if (tx + i < 0 || tx + i >= r->tiles_x)
                continue;
            bins = r->bins[(size_t)(ty + j) * r->tiles_x + tx + i];
            for (int k = 0; k < RF_BINS / 64; k++)
                window->word[k] |= bins.word[k];
            if (!square)
                while (least * least < gx * gx + gy * gy)
                    least++;
            if (bins.lamp > reach->lamp && bins.lamp >= (least - 1) * 256)
                reach->lamp = bins.lamp;
            if (least > 1)
                drop_short(&bins, scale, (least - 1) * 256);
            for (int k = 0; k < RF_BINS / 64; k++)
                reach->word[k] |= bins.word[k];
            reach->least = bins.least < reach->least ? bins.least : reach->least;
            reach->most = bins.most > reach->most ? bins.most : reach->most;
        }
    }
}

/* Cover the occupied bins from the near side. Slabs are a pixel wide, and half of that
 * where the blur is small and a pixel would show. The blurs below half a pixel are a slab
 * of their own with offset 0, which nothing else may take: they stay as they are. */
static void cover(const struct rf_bins *bins, struct rf_bin_scale scale,
                  struct rf_tile_plan *plan)
{
    const int pixel = 256 >> scale.shift;
    const int focus_end = scale.focus + scale.focus_bins;

    plan->slabs = 0;
    plan->reach = 0;
    plan->sharp = true;
    for (int bin = 0; bin < RF_BINS;) {
        int end = bin + pixel, last = bin, low, high, centre;

        if (!has(bins, bin)) {
            bin++;
            continue;
        }
        if (bin >= scale.focus && bin < focus_end) {
            plan->slab[plan->slabs++] = (struct rf_slab){-HALF, 2 * HALF - 1, 0};
            bin = focus_end;
            continue;
        }
        low = edge_of(scale, bin);
        if (pixel > 1 && low > -3 * 256 && low < 3 * 256)
            end = bin + pixel / 2;
        if (bin < scale.focus && end > scale.focus)
            end = scale.focus;
        for (int b = bin; b < end && b < RF_BINS; b++)
            if (has(bins, b))
                last = b;
        high = edge_of(scale, last + 1) - 1;
        low = low < bins->least ? bins->least : low;
        high = high > bins->most ? bins->most : high;
        centre = low + (high - low + 1) / 2; /* exact for a single blur */
        plan->sharp = false;
        if (-low > plan->reach)
            plan->reach = -low;
        if (high > plan->reach)
            plan->reach = high;
        low -= OVERLAP;
        high += OVERLAP;
        if (centre < 0 && high >= -HALF)
            high = -HALF - 1;
        if (centre > 0 && low < HALF)
            low = HALF;
        plan->slab[plan->slabs++] =
            (struct rf_slab){(int16_t)low, (uint16_t)(high - low), (int16_t)centre};
        bin = last + 1;
    }
}

void rf_plan_tile(const struct refocus_renderer *r, struct rf_bin_scale scale, int tx, int ty,
                  bool square, struct rf_tile_plan *plan)
{
    struct rf_bins reach, window;

    collect(r, scale, tx, ty, square, &reach, &window);
    cover(&reach, scale, plan);
    plan->lamp = reach.lamp > 0;
    plan->uniform = plan->slabs == 1 && !memcmp(reach.word, window.word, sizeof reach.word);
}
