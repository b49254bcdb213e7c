/* twin_windows.c: the blurs that lie around each place, in double precision; see
 * src/tiles/ranges.h and sort_rays in src/kernels/kernels.h. */
#include "twin.h"

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

void twin_cells(const struct twin *t, struct twin_cells *cells)
{
    cells->across = (t->width + TWIN_TILE - 1) / TWIN_TILE * (TWIN_TILE / TWIN_CELL);
    cells->down = (t->height + TWIN_TILE - 1) / TWIN_TILE * (TWIN_TILE / TWIN_CELL);
    cells->cell = malloc((size_t)(cells->across * cells->down) * sizeof *cells->cell);
    assert_non_null(cells->cell);
    for (int i = 0; i < cells->across * cells->down; i++) {
        struct twin_cell cell = {1e9, -1e9, -1e9};

        for (int j = 0; j < TWIN_CELL * TWIN_CELL; j++) {
            const int q = twin_at(t, i % cells->across * TWIN_CELL + j % TWIN_CELL,
                                  i / cells->across * TWIN_CELL + j / TWIN_CELL);

            cell.least = fmin(cell.least, t->blur[q]);
            cell.most = fmax(cell.most, t->blur[q]);
            if (t->background_blur[q] != t->blur[q])
                cell.foreground = fmax(cell.foreground, t->blur[q]);
        }
        cells->cell[i] = cell;
    }
}

/* Five cells across and three down hold a strip of 16 x 8 pixels wherever it lies. */
static struct twin_cell window(const struct twin_cells *cells, int x, int y)
{
    const int cx = (int)floor(x / (double)TWIN_CELL), cy = (int)floor(y / (double)TWIN_CELL);
    struct twin_cell all = {1e9, -1e9, -1e9};

    for (int i = 0; i < 15; i++) {
        const struct twin_cell *cell =
            &cells->cell[clamp(cy + i / 5, cells->down - 1) * cells->across +
                         clamp(cx + i % 5, cells->across - 1)];

        all.least = fmin(all.least, cell->least);
        all.most = fmax(all.most, cell->most);
        all.foreground = fmax(all.foreground, cell->foreground);
    }
    return all;
}

/* More than a slab is wide. */
static double bare_depth(const struct twin *t, double blur)
{
    return fmax(1.25 * t->unit, fabs(blur) * 5 / 32 - t->unit);
}

bool twin_is_deepest(const struct twin *t, const struct twin_cells *cells, struct twin_strip strip,
                     int dx, int dy, double low, double high)
{
    double least = 1e9, most = -1e9;
    bool bare = true;

    for (int y = strip.y; y < strip.y + strip.height; y += TWIN_TILE / 2) {
        const struct twin_cell seen = window(cells, strip.x + dx, y + dy);

        least = fmin(least, seen.least);
        most = fmax(most, seen.most);
        bare = bare && seen.foreground < seen.most - bare_depth(t, seen.most);
    }
    if (high - low > bare_depth(t, low > 0 ? low : high < 0 ? high : 0))
        return false;
    return bare && most >= low && most <= high && least < low;
}
