/* ranges.h: how little and how much the blur is around each place.
 *
 * A strip of a tile that is shifted by a ray's offset lies within some cells of RF_CELL x RF_CELL
 * pixels. r->range.at holds, for the cell it begins in, the least and the greatest blur of
 * all that it can lie in: kernels.h, windows. What is the same everywhere in a strip's sight, or
 * is not there at all, need not be looked for pixel by pixel.
 */
#ifndef RF_RANGES_H
#define RF_RANGES_H

#include "renderer/renderer.h"

/* Cells on each side of the picture. */
static inline int rf_range_border(int pad)
{
    return (pad + RF_CELL - 1) / RF_CELL;
}

/* Cells across, or down, with those. */
static inline int rf_range_width(int width, int pad)
{
    return (width + RF_TILE - 1) / RF_TILE * (RF_TILE / RF_CELL) + 2 * rf_range_border(pad);
}

/* Row y of cells: their least and their greatest blurs. They lie where the background's blur
 * will be. */
static inline int16_t *rf_cell_least(const struct refocus_renderer *r, int y)
{
    return r->background.blur.at + y * r->view.stride;
}

static inline int16_t *rf_cell_most(const struct refocus_renderer *r, int y)
{
    return rf_cell_least(r, y) + r->view.tiles_x * (RF_TILE / RF_CELL);
}

/* The cells of tile row ty. */
void rf_cell_rows(struct refocus_renderer *r, int ty);

/* One more blur in the cell of pixel (x, y). */
void rf_add_to_cell(struct refocus_renderer *r, int x, int y, int16_t blur);

/* The ranges of tile row ty, from all cells; for a photo of Y, U and V those of whole tiles. */
void rf_range_rows(struct refocus_renderer *r, uint16_t *scratch, int ty);

/* Once the background is filled and before there are weights: the foreground in the cells of tile
 * row ty; what else is foreground; and from all cells which ranges of row ty are bare (kernels.h).
 */
void rf_foreground_rows(struct refocus_renderer *r, int ty);
void rf_put_in_front(struct refocus_renderer *r, struct rf_rect pixels); /* all, to the last */
void rf_bare_rows(struct refocus_renderer *r, uint16_t *scratch, int ty);

#endif
