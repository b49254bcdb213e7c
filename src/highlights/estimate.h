/* estimate.h: an estimate of the light that the photo's white point cut off. */
#ifndef RF_ESTIMATE_H
#define RF_ESTIMATE_H

#include "highlights/highlights.h"
#include "highlights/light_grid.h"

/* The light that each cell has lost, as times the light that its clipped pixels have; below 0
 * where nothing is clipped. */
struct rf_estimate {
    const struct rf_light_grid *grid;
    float *lost;
    float scale; /* the estimate is multiplied by it; 0: for a fixed gain */
};

/* Bytes that rf_estimate_highlights() works in, for photos of at most this size. */
uint64_t rf_estimate_bytes(int max_width, int max_height);
void rf_estimate_lay_out(struct rf_estimate *estimate, struct rf_arena *arena);

/* Lists the highlights of a photo anew, by an estimate of the light that they lost, times `scale`.
 * With a scale of 0 it lists them for a fixed gain: all have lost the light that RF_MOST_GAIN adds,
 * and what may be no highlight a part of that. Exec and photo of the grid are set; works in
 * `arena`. What a cancelled run leaves is of no use. */
void rf_estimate_highlights(struct rf_light_grid *grid, struct rf_arena *arena,
                            const struct rf_transfer *linear, float scale,
                            struct rf_highlights *highlights);

/* Estimates the light that was lost from the grid's measures, by the scale. */
void rf_estimate_make(const struct rf_estimate *estimate);

/* Estimates how much light each cell of row y has lost, as times its own; for a fixed gain,
 * RF_MOST_GAIN - 1 where that is what it gets. Below 0 where nothing is clipped. */
void rf_estimate_cells(const struct rf_light_grid *grid, int y, bool fixed, float *lost);

/* The estimate along a row of the photo's pixels. */
struct rf_estimate_row {
    const struct rf_light_grid *grid;
    const float *lost[2]; /* the rows of cells above and below the middle of the pixels */
    float low;            /* place of the middle between these, 0 above to 1 below */
};
struct rf_estimate_row rf_estimate_row(const struct rf_estimate *estimate, int y);

/* The estimate for a pixel, between the middles of cells in proportion; 0 where nothing around is
 * clipped. */
float rf_estimate_at(const struct rf_estimate_row *row, int x);

/* Tells of each column of cells whether the estimate for some pixel in it may be `least`: 0 or 1.
 * Returns whether any may. */
bool rf_estimate_reaches(const struct rf_estimate_row *row, float least,
                         uint8_t reaches[RF_GRID_SIDE]);

/* The hue of the light around the clipped pixels of a cell, as times its luminance: of what
 * exceeds the surroundings. In each channel it is no farther from white than all the light near
 * the pixels, and white where the two are to different sides of it, which glare would hardly be
 * but paint may. Returns how far the hue is the highlight's own, 0 to 1: not at all where hardly
 * anything exceeds the surroundings. */
float rf_skirt_hue(const struct rf_light_grid *grid, int x, int y, float hue[3]);

/* How many pixels the clipped area around a cell is wide, or so. */
int rf_clipped_size(const struct rf_light_grid *grid, int x, int y);

#endif
