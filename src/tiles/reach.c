/* reach.c: collects the blurs that can reach a tile. */
#include "tiles/tiles.h"

#include <math.h>
#include <stdlib.h>

#include "support/compare.h"
#include "tiles/scale.h"

/* Clear bins [from, to). */
static void clear(uint64_t word[RF_BINS / 64], int from, int to)
{
    for (int i = 0; i < RF_BINS / 64; i++) {
        const int a = from - 64 * i < 0 ? 0 : from - 64 * i;
        const int b = to - 64 * i > 64 ? 64 : to - 64 * i;

        if (a < b)
            word[i] &= ~((b - a == 64 ? ~UINT64_C(0) : (UINT64_C(1) << (b - a)) - 1) << a);
    }
}

/* Pixels between tiles that are n tiles apart: those side by side are one pixel apart. */
static int gap_of(int n)
{
    return n ? (n - 1) * RF_TILE + 1 : 0;
}

/* A ray hits a pixel g away only if |s| >= g - 1. */
static struct rf_kept kept_at(struct rf_bin_scale scale, int gx, int gy, bool square)
{
    struct rf_kept kept = {.word = {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX}};
    int gap = gx > gy ? gx : gy;

    if (!square)
        while (gap * gap < gx * gx + gy * gy)
            gap++;
    kept.blur = ((gap - 1) * 256) >> scale.unit;
    if (gap > 1) {
        const int first = scale.unit ? rf_bin_of(scale, -kept.blur) + 1
                                     : rf_bin_of(scale, -kept.blur + (1 << scale.shift));
        const int end = rf_bin_of(scale, kept.blur);

        clear(kept.word, first, end);
        kept.low = rf_edge_of(scale, first);
        kept.high = rf_edge_of(scale, end);
    }
    return kept;
}

void rf_reach_init(struct rf_reach *reach, struct rf_bin_scale scale, float largest_blur, int pad,
                   bool square)
{
    /* No blur, not even one a bin larger, exceeds gap_of() - 1 of a tile farther away. */
    const int farthest = (int)((largest_blur + 1) / RF_TILE) + 1;

    reach->scale = scale;
    reach->square = square;
    reach->tiles = rf_smaller((pad - 2 + RF_TILE - 1) / RF_TILE, farthest);
    if (!scale.unit)
        reach->tiles = rf_smaller(reach->tiles, RF_REACH_TILES);
    for (int i = 0; scale.unit && i < RF_FAR_TILES; i++)
        reach->table.far[i] = kept_at(scale, i * RF_TILE, 0, square);
    for (int j = 0; !scale.unit && j <= reach->tiles; j++)
        for (int i = 0; i <= reach->tiles; i++)
            reach->table.kept[j][i] = kept_at(scale, gap_of(i), gap_of(j), square);
    for (int wide = 0; wide < 2; wide++)
        rf_slab_ends(scale, wide, reach->slab_end[wide]);
}

/* Adds the blurs of a tile that reach so far. */
static inline void add_kept(struct rf_bins_in_reach *reach, const struct rf_bins *bins,
                            const struct rf_kept *kept)
{
    struct rf_bins *const sum = &reach->all;
    uint64_t *word;
    const int least = bins->least, most = bins->most;
    const bool near = least < kept->low, far = most >= kept->high;
    const bool noisy = bins->noise > 0;

    if (bins->brightest > sum->brightest)
        sum->brightest = bins->brightest;
    if (bins->highlight > sum->highlight && bins->highlight >= kept->blur)
        sum->highlight = bins->highlight;
    if (bins->undersampled > sum->undersampled && bins->undersampled >= kept->blur)
        sum->undersampled = bins->undersampled;
    if (!near && !far)
        return;
    word = noisy ? sum->word : reach->sure;
    for (int k = 0; k < RF_BINS / 64; k++)
        word[k] |= bins->word[k] & kept->word[k];
    if (bins->steep) {
        sum->steep = true;
        for (int k = 0; k < RF_BINS / 64; k++)
            reach->steep[k] |= bins->word[k] & kept->word[k];
    }
    if (noisy) {
        reach->noise += bins->noise;
        reach->noisy++;
    }
    sum->least = (int16_t)rf_smaller(sum->least, near ? least : rf_larger(least, kept->high));
    sum->most = (int16_t)rf_larger(sum->most, far ? most : rf_smaller(most, kept->low - 1));
}

/* Collects those that reach it from single tiles. */
static struct rf_bins_in_reach collect_near(const struct rf_viewport *view,
                                            const struct rf_bins *bins,
                                            const struct rf_reach *reach, int tx, int ty)
{
    const int x0 = rf_larger(tx - reach->tiles, 0);
    const int x1 = rf_smaller(tx + reach->tiles, view->tiles_x - 1);
    const int y0 = rf_larger(ty - reach->tiles, 0);
    const int y1 = rf_smaller(ty + reach->tiles, view->tiles_y - 1);
    struct rf_bins_in_reach sum = {.all = {.least = INT16_MAX, .most = INT16_MIN}};

    for (int y = y0; y <= y1; y++) {
        const struct rf_bins *row = &bins[(size_t)y * view->tiles_x];
        const struct rf_kept *kept = reach->table.kept[abs(y - ty)];

        for (int x = x0; x <= tx; x++)
            add_kept(&sum, &row[x], &kept[tx - x]);
        for (int x = tx + 1; x <= x1; x++)
            add_kept(&sum, &row[x], &kept[x - tx]);
    }
    return sum;
}

/* Tiles of the photo before the window's first one in its block, across or down. */
static int in_block(int window)
{
    return window / RF_TILE % RF_BLOCK;
}

int rf_block_rows(const struct rf_viewport *view)
{
    return (view->tiles_y + in_block(view->y0) + RF_BLOCK - 1) / RF_BLOCK;
}

static int blocks_of_row(const struct rf_viewport *view)
{
    return (view->tiles_x + in_block(view->x0) + RF_BLOCK - 1) / RF_BLOCK;
}

/* The first tile of a block, which may be before the window, and the first one after it. */
static int block_from(int window, int block)
{
    return block * RF_BLOCK - in_block(window);
}

static struct rf_rect tiles_of(const struct rf_viewport *view, int bx, int by)
{
    const int x = block_from(view->x0, bx), y = block_from(view->y0, by);

    return (struct rf_rect){rf_larger(x, 0), rf_larger(y, 0),
                            rf_smaller(x + RF_BLOCK, view->tiles_x),
                            rf_smaller(y + RF_BLOCK, view->tiles_y)};
}

void rf_join_blocks(const struct rf_viewport *view, const struct rf_bins *bins,
                    struct rf_bins *blocks, int row)
{
    static const struct rf_kept all = {.word = {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX}};
    const int across = blocks_of_row(view);

    for (int bx = 0; bx < across; bx++) {
        const struct rf_rect tiles = tiles_of(view, bx, row);
        struct rf_bins_in_reach sum = {.all = {.least = INT16_MAX, .most = INT16_MIN}};
        uint64_t clean = 0; /* bins of tiles without noise, with which the block has none */

        for (int y = tiles.y0; y < tiles.y1; y++)
            for (int x = tiles.x0; x < tiles.x1; x++)
                add_kept(&sum, &bins[(size_t)y * view->tiles_x + x], &all);
        for (int k = 0; k < RF_BINS / 64; k++) {
            sum.all.word[k] |= sum.sure[k];
            clean |= sum.sure[k];
        }
        sum.all.noise = clean || !sum.noisy ? 0 : (int16_t)(sum.noise / sum.noisy);
        blocks[(size_t)row * across + bx] = sum.all;
    }
}

/* Tiles between a tile and those from `from` to `end` - 1, one more where there are any; 0: it is
 * one of them or beside them. */
static int away(int tile, int from, int end)
{
    const int n = tile < from ? from - tile : tile - end + 1;

    return n > 1 ? n - 1 : 0;
}

/* The blurs that reach so many tiles far, down to whole tiles. */
static const struct rf_kept *kept_from(const struct rf_reach *reach, int dx, int dy)
{
    const int n = reach->square ? rf_larger(dx, dy) : (int)sqrtf((float)(dx * dx + dy * dy));

    return &reach->table.far[n < RF_FAR_TILES ? n : RF_FAR_TILES - 1];
}

static void collect_block(struct rf_bins_in_reach *sum, const struct rf_viewport *view,
                          const struct rf_bins *bins, const struct rf_reach *reach, int tx, int ty,
                          struct rf_rect tiles)
{
    for (int y = tiles.y0; y < tiles.y1; y++)
        for (int x = tiles.x0; x < tiles.x1; x++)
            add_kept(sum, &bins[(size_t)y * view->tiles_x + x],
                     kept_from(reach, away(tx, x, x + 1), away(ty, y, y + 1)));
}

/* Collects those that reach it from blocks, and from single tiles in the blocks near it. */
static struct rf_bins_in_reach collect_far(const struct rf_viewport *view,
                                           const struct rf_bins *bins, const struct rf_reach *reach,
                                           int tx, int ty)
{
    const int across = blocks_of_row(view), most = reach->tiles;
    const int left = in_block(view->x0), above = in_block(view->y0);
    const int x0 = (rf_larger(tx - most, 0) + left) / RF_BLOCK;
    const int x1 = (rf_smaller(tx + most, view->tiles_x - 1) + left) / RF_BLOCK;
    const int y0 = (rf_larger(ty - most, 0) + above) / RF_BLOCK;
    const int y1 = (rf_smaller(ty + most, view->tiles_y - 1) + above) / RF_BLOCK;
    struct rf_bins_in_reach sum = {.all = {.least = INT16_MAX, .most = INT16_MIN}};

    for (int by = y0; by <= y1; by++)
        for (int bx = x0; bx <= x1; bx++) {
            const int x = block_from(view->x0, bx), y = block_from(view->y0, by);
            const int dx = away(tx, x, x + RF_BLOCK), dy = away(ty, y, y + RF_BLOCK);

            if (dx < RF_BLOCK && dy < RF_BLOCK)
                collect_block(&sum, view, bins, reach, tx, ty, tiles_of(view, bx, by));
            else
                add_kept(&sum, &reach->blocks[(size_t)by * across + bx], kept_from(reach, dx, dy));
        }
    return sum;
}

struct rf_bins_in_reach rf_collect(const struct rf_viewport *view, const struct rf_bins *bins,
                                   const struct rf_reach *reach, int tx, int ty)
{
    struct rf_bins_in_reach sum = reach->scale.unit ? collect_far(view, bins, reach, tx, ty)
                                                    : collect_near(view, bins, reach, tx, ty);

    for (int k = 0; k < RF_BINS / 64; k++)
        sum.all.word[k] |= sum.sure[k];
    return sum;
}
