/* tiles.h: finds the blurs that can reach a tile, and the slabs that rays test for them.
 *
 * A ray hits a pixel only if the circle of confusion there is as large as the pixel is far away. So
 * the blurs that occur in each tile are noted in bins, and a tile collects the bins around it as
 * far as they reach. These are covered, nearest first, by slabs: ranges of blur so narrow that a
 * ray can look for all of a slab at one offset, that of its centre.
 *
 * An example: a tile holds the blurs 5.0 to 7.4. The second tile to its right begins 17 pixels away
 * and holds the blurs 9 and 20. Blurs below 16 do not reach so far, so 20 alone is collected. The
 * slabs are 5 to 6, 6 to 7, 7 to 7.5 and 20, with the centres 5.5, 6.5, 7.25 and 20. For these the
 * ray (u, v) = (0.8, 0) looks 4.4, 5.2, 5.8 and 16 pixels to the right, rounded: 4, 5, 6 and 16.
 */
#ifndef RF_TILES_H
#define RF_TILES_H

#include "image/planes.h"
#include "image/viewport.h"
#include "kernels/slab.h"
#include "tiles/ranges.h"
#include "tiles/scale.h"

/* The scale of blurs of up to so many pixels. */
struct rf_bin_scale rf_bin_scale_of(float largest_blur, int unit);

enum { RF_MAX_SLABS = RF_BINS };

struct rf_tile_plan {
    int slabs;
    int reach;          /* largest |s| that reaches the tile, in 1/256 pixel, */
    int least;          /* the least |s| that reaches it */
    bool sharp;         /* nothing here or reaching here is blurred by half a pixel */
    int highlight;      /* largest |s| of a highlight in reach, 1/256 pixel; 0: none is in reach */
    bool undersampled;  /* a highlight that is narrow beside the gaps of the rays is in reach */
    uint16_t brightest; /* brightest light of the tiles in reach, as in rf_bins */
    int noise;          /* blurs that reach it vary so far from pixel to pixel, 1/256 pixel */
    struct rf_slab slab[RF_MAX_SLABS]; /* nearest first; one that closes a crack begins before the
                                          two that it follows */
    bool joined[RF_MAX_SLABS];         /* slab k overlaps slab k - 1, and a test may be of both */
};

/* Blurs that reach from a tile to another that is some tiles away. */
struct rf_kept {
    uint64_t word[RF_BINS / 64]; /* bit set of the bins that reach it */
    int low, high; /* blurs from low to high - 1 do not reach it, as they are stored */
    int blur;      /* the least |s| that does */
};

/*
 * Blurs in units of two pixels and more reach hundreds of tiles. So what is far from a tile is
 * collected from blocks of RF_BLOCK x RF_BLOCK tiles, each the union of its tiles. They lie at
 * multiples of RF_BLOCK in the photo, and reach a tile as their nearest pixel does.
 */
enum {
    RF_REACH_TILES = (RF_PLAIN_RADIUS + RF_TILE - 1) / RF_TILE,
    RF_FAR_TILES = (RF_UNIT_RADIUS << RF_MAX_UNIT) / RF_TILE + 3,
    RF_BLOCK = 4
};
struct rf_reach {
    struct rf_bin_scale scale;
    bool square; /* distances count by the larger axis */
    int tiles;   /* tiles farther away than this reach none */
    union {
        struct rf_kept kept[RF_REACH_TILES + 1][RF_REACH_TILES + 1]; /* [tiles down][across] */
        struct rf_kept far[RF_FAR_TILES];                            /* [tiles away], of blocks */
    } table;
    const struct rf_bins *blocks;  /* row by row, those that the window is in; only with a unit */
    uint16_t slab_end[2][RF_BINS]; /* rf_slab_ends() of slabs of a pixel and of wide ones */
};
/* Blocks that a window has, at most, of so many tiles. */
static inline int rf_blocks_across(int tiles)
{
    return (tiles + 2 * (RF_BLOCK - 1)) / RF_BLOCK;
}

/* Makes the blocks of row `row` of blocks from the bins of all tiles. */
void rf_join_blocks(const struct rf_viewport *view, const struct rf_bins *bins,
                    struct rf_bins *blocks, int row);
/* Rows of blocks of the window. */
int rf_block_rows(const struct rf_viewport *view);

/* Tabulates the reach of blurs up to the largest there can be in this frame, pixels, and pad - 2.
 * `square`: the aperture reaches beyond the unit circle, so that distances count by the larger
 * axis. */
void rf_reach_init(struct rf_reach *reach, struct rf_bin_scale scale, float largest_blur, int pad,
                   bool square);

/* Tabulates where the slab ends that a bin is in, of those that cover all bins from the nearest on:
 * slabs about a pixel wide or, with `wide`, wider from 16 pixels of blur on. */
void rf_slab_ends(struct rf_bin_scale scale, bool wide, uint16_t end[RF_BINS]);

/* Writes the bins of the tiles of row ty, whose cells are known (tiles/ranges.h). */
void rf_bin_tiles(const struct rf_viewport *view, struct rf_bin_scale scale, struct rf_blur_q8 blur,
                  const struct rf_cells *cells, struct rf_bins *bins, int ty);

/* Sets `flat` and `middle` of the bins of a noisy tile, whose first blur is at `s`: whether it is
 * level but for the noise, tiles/surfaces.h. */
void rf_find_flat(struct rf_bins *bins, struct rf_bin_scale scale, const int16_t *s,
                  ptrdiff_t stride);

/* Adds a blur to the bins of the tile that pixel (x, y) is in. */
void rf_add_bin(const struct rf_viewport *view, struct rf_bins *bins, struct rf_bin_scale scale,
                int x, int y, int16_t blur);

/* Writes to the bins of the tiles of row ty the background's blur in the middle of each. */
void rf_note_background_blur(const struct rf_viewport *view, struct rf_blur_q8 background_blur,
                             struct rf_bins *bins, int ty);

/* The bins of all tiles that reach a tile. */
struct rf_bins_in_reach {
    struct rf_bins all;
    uint64_t sure[RF_BINS / 64];  /* bins of the tiles without noise */
    uint64_t steep[RF_BINS / 64]; /* bins of the tiles with a steep surface */
    int64_t noise;                /* sum of that of the tiles with noise */
    int noisy;                    /* number of these */
};

/* The bins of all tiles that reach tile (tx, ty). */
struct rf_bins_in_reach rf_collect(const struct rf_viewport *view, const struct rf_bins *bins,
                                   const struct rf_reach *reach, int tx, int ty);

/* Finds everything the rays of a tile need, from the bins of those in reach. */
void rf_plan_tile(const struct rf_viewport *view, const struct rf_bins *bins,
                  const struct rf_reach *reach, int tx, int ty, struct rf_tile_plan *plan);

#endif
