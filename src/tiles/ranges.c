#include "tiles/ranges.h"

enum {
    EACH = RF_TILE / RF_CELL, /* cells of a tile, across and down */
    TALL_Y = RF_WINDOW_Y + RF_STRIP / RF_CELL, /* those that both its strips lie in */
};

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

/* The lesser and the greater ones of two rows of cells. */
static void join_rows(int16_t *restrict least, int16_t *restrict most,
                      const int16_t *const l[2], const int16_t *const m[2], int n)
{
    const int16_t *restrict l0 = l[0], *restrict l1 = l[1];
    const int16_t *restrict m0 = m[0], *restrict m1 = m[1];

    for (int x = 0; x < n; x++) {
        least[x] = l0[x] < l1[x] ? l0[x] : l1[x];
        most[x] = m0[x] > m1[x] ? m0[x] : m1[x];
    }
}

/* Luma and chroma of a tile are each swept in one go, so ranges are of both its strips:
 * five rows of cells come to three. */
static void join_strips(const int16_t *least[TALL_Y], const int16_t *most[TALL_Y],
                        int16_t *scratch, int n)
{
    for (int j = 0; j < TALL_Y - RF_WINDOW_Y; j++, scratch += 2 * n) {
        join_rows(scratch, scratch + n, &least[2 * j], &most[2 * j], n);
        least[2 * j] = scratch;
        most[2 * j] = scratch + n;
    }
    for (int j = 1; j < RF_WINDOW_Y; j++) {
        least[j] = least[2 * j];
        most[j] = most[2 * j];
    }
}

void rf_range_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const int n = cells_x(r), rows = r->tiles_y * EACH, border = rf_range_border(r->pad);
    const int first = ty == 0 ? -border : ty * EACH;
    const int end = ty == r->tiles_y - 1 ? rows + border : (ty + 1) * EACH;

    int16_t *const joined = (int16_t *)scratch + 2 * (n + 2 * border + RF_WINDOW_X);

    for (int y = first; y < end; y++) {
        const int16_t *least[TALL_Y], *most[TALL_Y];

        for (int j = 0; j < TALL_Y; j++) {
            least[j] = rf_cell_least(r, clamp(y + j, rows - 1));
            most[j] = rf_cell_most(r, clamp(y + j, rows - 1));
        }
        if (r->yuv.on)
            join_strips(least, most, joined, n);
        r->kernels.windows(r->range + y * r->range_stride - border, least, most,
                           (int16_t *)scratch, n, border);
    }
}
