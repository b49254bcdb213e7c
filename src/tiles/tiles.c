/* tiles.c: notes the blurs of each tile, and how noisy they are. */
#include "tiles/tiles.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "colour/transfer.h"
#include "support/compare.h"
#include "tiles/scale.h"

enum { EACH = RF_TILE / RF_CELL }; /* cells of a tile, across and down */

enum {
    HALF = 128, /* 1/256 pixel, as all of these */
    LARGEST = RF_PLAIN_RADIUS * 256,
    LEAST_NOISE = 64, /* tiles of less noise are clean */
    STEEP = 384,      /* over three pixels; rays can pass such a surface between slabs */
    CONTINUOUS = 256, /* pixels beside each other that differ by no more are of one surface */
    NARROWEST = 4,    /* shift of the narrowest bins */
};

struct rf_bin_scale rf_bin_scale_of(float largest_blur, int unit)
{
    int shift = NARROWEST;

    /* So -7.5 .. 7.5 pixels are bins 15 .. 255 at shift 4, -15.5 .. 15.5 bins 7 .. 255 at shift 5,
     * -31.5 .. 31.5 bins 3 .. 255 at shift 6, -63.5 .. 63.5 bins 1 .. 255 at shift 7, -127 .. 127
     * bins 0 .. 254 at shift 8. */
    while (shift < 8 && (unit || largest_blur > (float)(1 << shift) * 0.5f - 0.5f))
        shift++;
    static_assert(((15 * 128 + HALF) >> 4) + 127 < RF_BINS, "bins of 7.5 pixels at shift 4");
    static_assert(((31 * 128 + HALF) >> 5) + 127 < RF_BINS, "bins of 15.5 pixels at shift 5");
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

/* Notes the bins of a cell's blurs. */
static void note_cell(uint8_t found[RF_BINS], struct rf_bin_scale scale, const int16_t *s,
                      ptrdiff_t stride)
{
    uint8_t bin[RF_CELL * RF_CELL];

    for (int i = 0; i < RF_CELL * RF_CELL; i++)
        bin[i] = (uint8_t)rf_bin_of(scale, s[i / RF_CELL * stride + i % RF_CELL]);
    for (int i = 0; i < RF_CELL * RF_CELL; i++)
        found[bin[i]] = 1;
}

/* Adds the blurs of a tile's cells, pixel by pixel where a cell may have more than two bins; all
 * are in bins from `least` to `most`. */
static void add_cells(struct rf_bins *bins, struct rf_bin_scale scale, struct rf_blur_q8 blur,
                      const struct rf_cells *cells, int tx, int ty, int least, int most)
{
    uint8_t found[RF_BINS];

    memset(found + least, 0, (size_t)most - (size_t)least + 1);
    for (int y = ty * EACH; y < (ty + 1) * EACH; y++)
        for (int x = tx * EACH; x < (tx + 1) * EACH; x++) {
            const int first = rf_bin_of(scale, cells->least[y * cells->stride + x]);
            const int last = rf_bin_of(scale, cells->most[y * cells->stride + x]);

            found[first] = 1;
            found[last] = 1;
            if (last - first > 1)
                note_cell(found, scale, blur.at + RF_CELL * (y * blur.stride + x), blur.stride);
        }
    for (int bin = least; bin <= most; bin++)
        bins->word[bin / 64] |= (uint64_t)found[bin] << bin % 64;
}

/* Whether at least every second bin from that of one blur to that of another occurs: between the
 * two surfaces of a thin structure there is nothing. */
static bool is_dense(const struct rf_bins *bins, struct rf_bin_scale scale, int low, int high)
{
    const int first = rf_bin_of(scale, low), last = rf_bin_of(scale, high);
    int found = 0;

    for (int k = first / 64; k <= last / 64; k++) {
        const uint64_t from = k == first / 64 ? UINT64_MAX << first % 64 : UINT64_MAX;
        const uint64_t to = k == last / 64 ? UINT64_MAX >> (63 - last % 64) : UINT64_MAX;

        found += __builtin_popcountll(bins->word[k] & from & to);
    }
    return 2 * found > last - first;
}

/* The noise of a tile: how far the blurs of all four cells of a block of 2 x 2 overlap, in the
 * second of the tile's four blocks. Cells of a slope lie beside each other, and those on either
 * side of an edge apart, but noise makes them all alike: by about 2.5 standard deviations if it is
 * Gaussian. Where an edge cuts two or three of the blocks, one that it leaves whole tells. */
static int16_t noise_of_tile(const struct rf_bins *bins, struct rf_bin_scale scale,
                             const struct rf_cells *cells, int tx, int ty)
{
    int largest = 0, second = 0, block = 0, cut = 0;
    int overlap[EACH];

    static_assert(EACH == 4, "a tile has four blocks of 2 x 2 cells");
    for (int y = ty * EACH; y < (ty + 1) * EACH; y += 2)
        for (int x = tx * EACH; x < (tx + 1) * EACH; x += 2) {
            const int16_t *a = cells->least + y * cells->stride + x, *b = a + cells->stride;
            const int16_t *c = cells->most + y * cells->stride + x, *d = c + cells->stride;
            const int low = rf_larger(rf_larger(a[0], a[1]), rf_larger(b[0], b[1]));
            const int high = rf_smaller(rf_smaller(c[0], c[1]), rf_smaller(d[0], d[1]));

            overlap[block++] = high - low;
            if (high - low <= LEAST_NOISE >> scale.unit || !is_dense(bins, scale, low, high))
                continue;
            second = rf_larger(second, rf_smaller(largest, high - low));
            largest = rf_larger(largest, high - low);
        }
    for (int k = 0; k < EACH; k++)
        cut += overlap[k] < -largest;
    return (int16_t)rf_smaller(cut >= 2 ? largest : second, INT16_MAX);
}

/* Whether a cell is of one surface, so that pixels beside each other differ little, which slopes by
 * more than half a pixel of blur a pixel along one of its rows or columns. */
static bool is_steep_cell(const int16_t *s, ptrdiff_t stride, int unit)
{
    enum { LAST = RF_CELL - 1 };
    const int steep = STEEP >> unit, most = CONTINUOUS >> unit;
    bool slopes = false, is_one = true;

    for (int i = 0; i < RF_CELL; i++) {
        const int16_t *const row = s + i * stride, *const column = s + i;

        slopes |= abs(row[LAST] - row[0]) > steep;
        slopes |= abs(column[LAST * stride] - column[0]) > steep;
        for (int k = 1; k < RF_CELL; k++) {
            is_one &= abs(row[k] - row[k - 1]) <= most;
            is_one &= abs(column[k * stride] - column[(k - 1) * stride]) <= most;
        }
    }
    return slopes && is_one;
}

static bool is_steep(struct rf_bin_scale scale, struct rf_blur_q8 blur,
                     const struct rf_cells *cells, int tx, int ty)
{
    for (int y = ty * EACH; y < (ty + 1) * EACH; y++)
        for (int x = tx * EACH; x < (tx + 1) * EACH; x++) {
            const ptrdiff_t cell = y * cells->stride + x;

            if (cells->most[cell] - cells->least[cell] > STEEP >> scale.unit &&
                is_steep_cell(blur.at + RF_CELL * (y * blur.stride + x), blur.stride, scale.unit))
                return true;
        }
    return false;
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
    if (last - first > 1) {
        add_cells(&bins, scale, blur, cells, tx, ty, first, last);
        bins.noise = noise_of_tile(&bins, scale, cells, tx, ty);
        bins.steep = is_steep(scale, blur, cells, tx, ty);
        if (bins.noise)
            rf_find_flat(&bins, scale, blur.at + RF_TILE * (ty * blur.stride + tx), blur.stride);
    }
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
