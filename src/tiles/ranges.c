#include "tiles/ranges.h"

enum {
    EACH = RF_TILE / RF_CELL,                  /* cells of a tile, across and down */
    TALL_Y = RF_WINDOW_Y + RF_STRIP / RF_CELL, /* those that both its strips lie in */
};

static int cells_x(const struct refocus_renderer *r)
{
    return r->view.tiles_x * EACH;
}

void rf_cell_rows(struct refocus_renderer *r, int ty)
{
    const int n = cells_x(r);

    for (int y = ty * EACH; y < (ty + 1) * EACH; y++)
        r->exec.kernels->cells(rf_cell_least(r, y), rf_cell_most(r, y),
                               r->blur.at + y * RF_CELL * r->view.stride, r->view.stride, n);
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

static void lesser_row(int16_t *restrict out, const int16_t *restrict a, const int16_t *restrict b,
                       int n)
{
    for (int x = 0; x < n; x++)
        out[x] = rf_lesser(a[x], b[x]);
}

static void greater_row(int16_t *restrict out, const int16_t *restrict a, const int16_t *restrict b,
                        int n)
{
    for (int x = 0; x < n; x++)
        out[x] = rf_greater(a[x], b[x]);
}

/* Luma and chroma of a tile are each swept in one go, so ranges are of both its strips:
 * five rows of cells come to three. */
static void join_strips(const int16_t *row[TALL_Y], int16_t *scratch, int n,
                        void (*join)(int16_t *, const int16_t *, const int16_t *, int))
{
    for (int j = 0; j < TALL_Y - RF_WINDOW_Y; j++, scratch += n) {
        join(scratch, row[2 * j], row[2 * j + 1], n);
        row[2 * j] = scratch;
    }
    for (int j = 1; j < RF_WINDOW_Y; j++)
        row[j] = row[2 * j];
}

/* Rows of windows of a row of tiles; the first and the last with the border. */
struct window_rows {
    int cells, border; /* across */
    int first, end;
    int last; /* row of cells */
};

static struct window_rows window_rows(const struct refocus_renderer *r, int ty)
{
    const int rows = r->view.tiles_y * EACH, border = rf_range_border(r->view.pad);

    return (struct window_rows){
        .cells = cells_x(r),
        .border = border,
        .first = ty == 0 ? -border : ty * EACH,
        .end = ty == r->view.tiles_y - 1 ? rows + border : (ty + 1) * EACH,
        .last = rows - 1,
    };
}

/* Behind the scratch of `windows`. */
static int16_t *joined_rows(uint16_t *scratch, const struct window_rows *rows)
{
    return (int16_t *)scratch + 2 * (rows->cells + 2 * rows->border + RF_WINDOW_X);
}

void rf_range_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const struct window_rows rows = window_rows(r, ty);
    int16_t *const joined = joined_rows(scratch, &rows);

    for (int y = rows.first; y < rows.end; y++) {
        const int16_t *least[TALL_Y], *most[TALL_Y];

        for (int j = 0; j < TALL_Y; j++) {
            least[j] = rf_cell_least(r, clamp(y + j, rows.last));
            most[j] = rf_cell_most(r, clamp(y + j, rows.last));
        }
        if (r->yuv.on) {
            join_strips(least, joined, rows.cells, lesser_row);
            join_strips(most, joined + 2 * rows.cells, rows.cells, greater_row);
        }
        r->exec.kernels->windows(r->range.at + y * r->range.stride - rows.border, least, most,
                                 (int16_t *)scratch, rows.cells, rows.border);
    }
}

/* They lie where the weights will be. */
static int16_t *foreground_row(const struct refocus_renderer *r, int y)
{
    return (int16_t *)r->weight.at + y * r->weight.stride;
}

void rf_foreground_rows(struct refocus_renderer *r, int ty)
{
    for (int y = ty * EACH; y < (ty + 1) * EACH; y++) {
        const ptrdiff_t at = y * RF_CELL * r->view.stride;

        r->exec.kernels->foreground(foreground_row(r, y), r->blur.at + at,
                                    r->background.blur.at + at, r->view.stride, cells_x(r));
    }
}

void rf_put_in_front(struct refocus_renderer *r, struct rf_rect pixels)
{
    const int last_x = cells_x(r) - 1, last_y = r->view.tiles_y * EACH - 1;

    for (int y = clamp(pixels.y0 / RF_CELL, last_y); y <= clamp(pixels.y1 / RF_CELL, last_y); y++)
        for (int x = clamp(pixels.x0 / RF_CELL, last_x); x <= clamp(pixels.x1 / RF_CELL, last_x);
             x++)
            foreground_row(r, y)[x] = INT16_MAX;
}

void rf_bare_rows(struct refocus_renderer *r, uint16_t *scratch, int ty)
{
    const struct window_rows rows = window_rows(r, ty);

    for (int y = rows.first; y < rows.end; y++) {
        const int16_t *cell[TALL_Y];

        for (int j = 0; j < TALL_Y; j++)
            cell[j] = foreground_row(r, clamp(y + j, rows.last));
        if (r->yuv.on)
            join_strips(cell, joined_rows(scratch, &rows), rows.cells, greater_row);
        r->exec.kernels->bare(r->range.at + y * r->range.stride - rows.border, cell,
                              (int16_t *)scratch, rows.cells, rows.border);
    }
}
