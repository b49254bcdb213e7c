/* ranges.c: finds the least and the greatest blur of cells, and of the window that a shifted strip
 * lies in. */
#include "tiles/ranges.h"
#include "support/compare.h"

enum {
    EACH = RF_TILE / RF_CELL,                  /* cells of a tile, across and down */
    TALL_Y = RF_WINDOW_Y + RF_STRIP / RF_CELL, /* cells that both strips of a tile lie in */
};

static int cells_x(const struct rf_viewport *view)
{
    return view->tiles_x * EACH;
}

void rf_cell_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                  struct rf_blur_q8 blur, const struct rf_cells *cells, int ty)
{
    const int n = cells_x(view);

    for (int y = ty * EACH; y < (ty + 1) * EACH; y++)
        exec->kernels->cells(cells->least + y * cells->stride, cells->most + y * cells->stride,
                             blur.at + y * RF_CELL * blur.stride, blur.stride, n);
}

void rf_add_to_cell(const struct rf_cells *cells, int x, int y, int16_t blur)
{
    const ptrdiff_t at = y / RF_CELL * cells->stride + x / RF_CELL;

    cells->least[at] = rf_lesser(blur, cells->least[at]);
    cells->most[at] = rf_greater(blur, cells->most[at]);
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

static struct window_rows window_rows(const struct rf_viewport *view, int ty)
{
    const int rows = view->tiles_y * EACH, border = rf_range_border(view->pad);

    return (struct window_rows){
        .cells = cells_x(view),
        .border = border,
        .first = ty == 0 ? -border : ty * EACH,
        .end = ty == view->tiles_y - 1 ? rows + border : (ty + 1) * EACH,
        .last = rows - 1,
    };
}

/* Joined rows lie in the scratch after what the kernels need there. */
static int16_t *joined_rows(int16_t *scratch, const struct window_rows *rows)
{
    return scratch + 2 * (rows->cells + 2 * rows->border + RF_WINDOW_X);
}

void rf_range_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                   const struct rf_range_pass *pass, int ty, int worker)
{
    const struct window_rows rows = window_rows(view, ty);
    int16_t *const scratch = (int16_t *)rf_scratch(exec, worker);
    int16_t *const joined = joined_rows(scratch, &rows);

    for (int y = rows.first; y < rows.end; y++) {
        const int16_t *least[TALL_Y], *most[TALL_Y];

        for (int j = 0; j < TALL_Y; j++) {
            const ptrdiff_t at = rf_clamp(y + j, 0, rows.last) * pass->cells.stride;

            least[j] = pass->cells.least + at;
            most[j] = pass->cells.most + at;
        }
        if (pass->whole_tiles) {
            join_strips(least, joined, rows.cells, lesser_row);
            join_strips(most, joined + 2 * rows.cells, rows.cells, greater_row);
        }
        exec->kernels->windows(pass->range.at + y * pass->range.stride - rows.border, least, most,
                               scratch, rows.cells, rows.border);
    }
}

void rf_foreground_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                        struct rf_blur_q8 blur, struct rf_blur_q8 background_blur,
                        const struct rf_foreground_cells *foreground, int ty)
{
    for (int y = ty * EACH; y < (ty + 1) * EACH; y++) {
        const ptrdiff_t at = y * RF_CELL * blur.stride;

        exec->kernels->foreground(foreground->most + y * foreground->stride, blur.at + at,
                                  background_blur.at + at, blur.stride, cells_x(view));
    }
}

void rf_force_foreground(const struct rf_viewport *view,
                         const struct rf_foreground_cells *foreground, struct rf_rect pixels)
{
    const int last_x = cells_x(view) - 1, last_y = view->tiles_y * EACH - 1;

    for (int y = rf_clamp(pixels.y0 / RF_CELL, 0, last_y);
         y <= rf_clamp(pixels.y1 / RF_CELL, 0, last_y); y++)
        for (int x = rf_clamp(pixels.x0 / RF_CELL, 0, last_x);
             x <= rf_clamp(pixels.x1 / RF_CELL, 0, last_x); x++)
            foreground->most[y * foreground->stride + x] = INT16_MAX;
}

void rf_mark_ranges_in_background(const struct rf_executor *exec, const struct rf_viewport *view,
                                  const struct rf_range_pass *pass, int ty, int worker)
{
    const struct window_rows rows = window_rows(view, ty);
    int16_t *const scratch = (int16_t *)rf_scratch(exec, worker);

    for (int y = rows.first; y < rows.end; y++) {
        const int16_t *cell[TALL_Y];

        for (int j = 0; j < TALL_Y; j++)
            cell[j] =
                pass->foreground.most + rf_clamp(y + j, 0, rows.last) * pass->foreground.stride;
        if (pass->whole_tiles)
            join_strips(cell, joined_rows(scratch, &rows), rows.cells, greater_row);
        exec->kernels->mark_in_background(pass->range.at + y * pass->range.stride - rows.border,
                                          cell, scratch, rows.cells, rows.border);
    }
}
