#include "tiles/ranges.h"

enum { EACH = RF_TILE / RF_CELL }; /* cells of a tile, across and down */

static int cells_x(const struct refocus_renderer *r)
{
    return r->tiles_x * EACH;
}

void rf_cell_rows(struct refocus_renderer *r, int ty)
{
    const int n = cells_x(r);

    for (int y = ty * EACH; y < (ty + 1) * EACH; y++)
        r->kernels.cells(rf_cell_least(r, y), rf_cell_most(r, y),
                         r->front.blur + y * RF_CELL * r->stride, r->stride, n);
}

void rf_add_to_cell(struct refocus_renderer *r, int x, int y, int16_t blur)
{
    int16_t *least = rf_cell_least(r, y / RF_CELL) + x / RF_CELL;
    int16_t *most = rf_cell_most(r, y / RF_CELL) + x / RF_CELL;

    *least = blur < *least ? blur : *least;
    *most = blur > *most ? blur : *most;
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

void rf_range_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const int n = cells_x(r), rows = r->tiles_y * EACH, border = rf_range_border(r->pad);
    const int first = ty == 0 ? -border : ty * EACH;
    const int end = ty == r->tiles_y - 1 ? rows + border : (ty + 1) * EACH;

    for (int y = first; y < end; y++) {
        const int16_t *least[RF_WINDOW_Y], *most[RF_WINDOW_Y];

        for (int j = 0; j < RF_WINDOW_Y; j++) {
            least[j] = rf_cell_least(r, clamp(y + j, rows - 1));
            most[j] = rf_cell_most(r, clamp(y + j, rows - 1));
        }
        r->kernels.windows(r->range + y * r->range_stride - border, least, most,
                           (int16_t *)scratch, n, border);
    }
}
