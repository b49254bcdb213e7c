/* light_grid.c: measures the means that lost light is estimated from. */
#include "highlights/light_grid.h"

#include <math.h>
#include <string.h>

#include "support/compare.h"
#include "support/log2.h"

static const struct {
    int first, last;
} scales[RF_GRID_MEASURES] = {
    [RF_GRID_CLIPPED] = {0, 6}, [RF_GRID_UNCLIPPED] = {1, 6},     [RF_GRID_LOG] = {1, 6},
    [RF_GRID_GREY] = {1, 1},    [RF_GRID_PLATEAU] = {1, 1},       [RF_GRID_WHITE] = {1, 1},
    [RF_GRID_RED] = {1, 4},     [RF_GRID_GREEN] = {1, 4},         [RF_GRID_BLUE] = {1, 4},
    [RF_GRID_DARK] = {1, 3},    [RF_GRID_LIGHT] = {1, 3},         [RF_GRID_LIGHT_SQUARED] = {1, 3},
    [RF_GRID_GLARE] = {1, 6},   [RF_GRID_GLARE_SQUARED] = {1, 3}, [RF_GRID_GLARE_LIGHT] = {1, 3},
};

static void lay_out(struct rf_light_grid *grid, struct rf_arena *arena)
{
    grid->tables = rf_arena_take(arena, 1, sizeof *grid->tables);
    for (int i = 0; i < RF_GRID_MEASURES; i++) {
        grid->plane[i].first = scales[i].first;
        grid->plane[i].last = scales[i].last;
        for (int k = scales[i].first; k <= scales[i].last; k++)
            grid->plane[i].scale[k] = rf_arena_take(arena,
                                                    (uint64_t)rf_grid_size(grid->width, k) *
                                                        (uint64_t)rf_grid_size(grid->height, k),
                                                    sizeof(float));
    }
}

uint64_t rf_light_grid_bytes(int max_width, int max_height)
{
    struct rf_light_grid grid = {.width = rf_smaller(max_width, RF_GRID_SIDE),
                                 .height = rf_smaller(max_height, RF_GRID_SIDE)};
    struct rf_arena arena = {NULL, 0};

    lay_out(&grid, &arena);
    return arena.used;
}

/* The number of cells along a side of the photo: one for each pixel, or an even number, so that
 * each pair of them is as wide as the others. */
static int cells_of(int pixels, int longer)
{
    if (longer <= RF_GRID_SIDE)
        return pixels;
    return rf_smaller(2 * rf_larger((pixels * RF_GRID_SIDE / 2 + longer / 2) / longer, 1), pixels);
}

void rf_light_grid_lay_out(struct rf_light_grid *grid, struct rf_arena *arena)
{
    const int width = grid->photo->width, height = grid->photo->height;
    const int longer = rf_larger(width, height), side = rf_smaller(longer, RF_GRID_SIDE);

    grid->width = cells_of(width, longer);
    grid->height = cells_of(height, longer);
    grid->step = rf_larger(3 * longer / (4 * side), 1); /* 3/8 of two cells */
    lay_out(grid, arena);
}

/* The first pixel of a cell, of `pixels` in `cells`. */
static int first_of(int cell, int pixels, int cells)
{
    return (int)(((int64_t)cell * pixels + cells - 1) / cells);
}

static int greatest(const int v[3])
{
    return rf_larger(v[0], rf_larger(v[1], v[2]));
}

static int least(const int v[3])
{
    return rf_smaller(v[0], rf_smaller(v[1], v[2]));
}

static int part(int code, int from, int to)
{
    return code <= from ? 0 : code >= to ? 256 : 256 * (code - from) / (to - from);
}

/* Sets the tables for the photo's blend. */
static void set_tables(struct rf_light_grid *grid, const struct rf_transfer *linear)
{
    struct rf_grid_tables *t = grid->tables;
    const struct rf_transfer *own = grid->photo->transfer;

    for (int x = 0; x <= grid->width; x++)
        t->first[x] = first_of(x, grid->photo->width, grid->width);
    t->clipped = 0;
    for (int i = 0; i < RF_CODES_OF_LIGHT; i++) {
        const int code = own->to_code[4 * i], v = part(code, 242, 254);
        const double light = i / 4095.0, dark = 1 / ((light + 0.002) * (light + 0.002));

        t->linear[i] = own == linear ? (uint16_t)i : linear->to_light[code];
        t->soft[i] = (uint16_t)((v * v * (768 - 2 * v) + (1 << 15)) >> 16);
        t->plateau[i] = (uint16_t)part(code, 250, 255);
        t->white[i] = (uint16_t)part(code, 246, 255);
        t->log[i] = (uint16_t)floor((rf_log2(i / 4095.0 + 0.003) + 9) * 256 + 0.5);
        t->dark[i] = (uint16_t)(dark / 4 + 0.5);
        t->light[i] = (uint16_t)(256 * dark * light + 0.5);
        t->light_squared[i] = (uint16_t)(32768 * dark * light * light + 0.5);
        if (t->soft[i] == 0)
            t->clipped = i;
    }
}

static void add(const struct rf_light_grid *grid, enum rf_grid_measure measure, int x, int y,
                int sum)
{
    const int k = scales[measure].first;

    grid->plane[measure].scale[k][(y >> k) * rf_grid_size(grid->width, k) + (x >> k)] += (float)sum;
}

/* Adds up light that is not clipped, in one row of cells y of scale 1. */
static void add_unclipped(const struct rf_light_grid *grid, int y, int row)
{
    const struct rf_grid_tables *t = grid->tables;
    const int across = rf_grid_size(grid->width, 1);
    const int width = grid->photo->width, step = grid->step, clipped = t->clipped;
    const int run = grid->photo->yuv ? RF_GRID_RUN : width;
    uint8_t rgb[3 * RF_GRID_RUN];
    struct rf_grid_pixels pixels = {.code = NULL};
    float *sum[RF_GRID_MEASURES];
    int x = 0, from = 0, to = 0; /* pixels `from` to `to` - 1 are found */

    for (int i = 0; i < RF_GRID_MEASURES; i++)
        sum[i] = grid->plane[i].scale[1] + (ptrdiff_t)row * across;
    for (int cx = 0; cx < across; cx++) {
        const int end = t->first[rf_smaller(2 * cx + 2, grid->width)];
        int light[3] = {0}, luminance = 0, log = 0, dark = 0, lit = 0, squared = 0;

        for (; x < end; x += step) {
            int colour[3], left = 256, own;

            if (x >= to) {
                from = x & ~1;
                to = rf_smaller(from + run, width);
                pixels = rf_grid_pixels(grid, from, y, to - from, rgb);
            }
            rf_grid_colour(&pixels, x - from, colour);
            if (greatest(colour) > clipped)
                left -= t->soft[greatest(colour)];
            for (int c = 0; c < 3; c++) {
                colour[c] = t->linear[colour[c]];
                light[c] += (left * colour[c]) >> 8;
            }
            own = (218 * colour[0] + 732 * colour[1] + 74 * colour[2]) >> 10;
            luminance += (left * own) >> 8;
            log += t->log[own];
            dark += (left * t->dark[own]) >> 8;
            lit += (left * t->light[own]) >> 8;
            squared += (left * t->light_squared[own]) >> 8;
        }
        sum[RF_GRID_UNCLIPPED][cx] += (float)luminance;
        sum[RF_GRID_LOG][cx] += (float)log;
        sum[RF_GRID_DARK][cx] += (float)dark;
        sum[RF_GRID_LIGHT][cx] += (float)lit;
        sum[RF_GRID_LIGHT_SQUARED][cx] += (float)squared;
        for (int c = 0; c < 3; c++)
            sum[RF_GRID_RED + c][cx] += (float)light[c];
    }
}

/* Adds up what is clipped of n pixels of a row, cell by cell. */
static void add_clipped(const struct rf_light_grid *grid, int x, int y, int n, int cy)
{
    const struct rf_grid_tables *t = grid->tables;
    uint8_t rgb[3 * RF_GRID_RUN];
    const struct rf_grid_pixels pixels = rf_grid_pixels(grid, x, y, n, rgb);

    for (int i = 0, cx = rf_grid_cell(x, grid->photo->width, grid->width); i < n; cx++) {
        const int end = rf_smaller(t->first[cx + 1] - x, n);
        int soft = 0, grey = 0, plateau = 0, white = 0;

        for (; i < end; i++) {
            int colour[3], most, lowest, own;

            rf_grid_colour(&pixels, i, colour);
            most = greatest(colour);
            own = t->soft[most];
            if (own == 0)
                continue;
            lowest = least(colour);
            soft += own;
            grey += lowest == most ? 16 * own : 16 * own * t->linear[lowest] / t->linear[most];
            plateau += t->plateau[most];
            white += t->white[lowest];
        }
        if (soft == 0)
            continue;
        add(grid, RF_GRID_CLIPPED, cx, cy, soft);
        add(grid, RF_GRID_GREY, cx, cy, grey);
        add(grid, RF_GRID_PLATEAU, cx, cy, plateau);
        add(grid, RF_GRID_WHITE, cx, cy, white);
    }
}

static int multiples_in(int from, int to, int step)
{
    return step == 1 ? to - from : (to + step - 1) / step - (from + step - 1) / step;
}

/* Makes means of the sums in a row of cells at its plane's first scale. */
static void divide(const struct rf_light_grid *grid, enum rf_grid_measure measure, int row,
                   float unit, bool sampled)
{
    const struct rf_grid_plane *plane = &grid->plane[measure];
    const int k = plane->first, height = grid->photo->height;
    const int across = rf_grid_size(grid->width, k), step = sampled ? grid->step : 1;
    const int *const first = grid->tables->first;
    float *at = plane->scale[k] + (ptrdiff_t)row * across;
    const int y0 = first_of(row << k, height, grid->height);
    const int y1 = first_of(rf_smaller((row + 1) << k, grid->height), height, grid->height);
    const int rows = multiples_in(y0, y1, step);

    for (int x = 0; x < across; x++) {
        if (at[x] > 0) { /* few are, of those that count what is clipped */
            const int end = first[rf_smaller((x + 1) << k, grid->width)];

            at[x] /= (float)rf_larger(multiples_in(first[x << k], end, step) * rows, 1) * unit;
        }
    }
}

/* Measures two rows of cells. */
static void measure_rows(void *context, int item, int worker)
{
    const struct rf_light_grid *grid = context;
    const int width = grid->photo->width, height = grid->photo->height;

    (void)worker;
    for (int i = 0; i < RF_GRID_MEASURES; i++) {
        const int k = grid->plane[i].first, rows = k ? 1 : 2;
        const int across = rf_grid_size(grid->width, k);

        for (int row = rows * item; row < rows * (item + 1) && row < rf_grid_size(grid->height, k);
             row++)
            memset(grid->plane[i].scale[k] + (ptrdiff_t)row * across, 0,
                   (size_t)across * sizeof(float));
    }
    for (int cy = 2 * item; cy < rf_smaller(2 * item + 2, grid->height); cy++) {
        const int end = first_of(cy + 1, height, grid->height);

        for (int y = first_of(cy, height, grid->height); y < end; y++) {
            if (rf_cancelled(grid->exec))
                return;
            if (y % grid->step == 0)
                add_unclipped(grid, y, item);
            if (!rf_grid_may_be_clipped(grid, 0, y, width))
                continue;
            for (int x = 0, n; x < width; x += n) {
                n = rf_smaller(width - x, RF_GRID_RUN);
                if (rf_grid_may_be_clipped(grid, x, y, n))
                    add_clipped(grid, x, y, n, cy);
            }
        }
        divide(grid, RF_GRID_CLIPPED, cy, 256, false);
    }
    divide(grid, RF_GRID_UNCLIPPED, item, 4095, true);
    divide(grid, RF_GRID_LOG, item, 256, true);
    divide(grid, RF_GRID_GREY, item, 4096, false);
    divide(grid, RF_GRID_PLATEAU, item, 256, false);
    divide(grid, RF_GRID_WHITE, item, 256, false);
    for (int i = RF_GRID_RED; i <= RF_GRID_BLUE; i++)
        divide(grid, (unsigned)i, item, 4095, true);
    divide(grid, RF_GRID_DARK, item, 0.25f, true);
    divide(grid, RF_GRID_LIGHT, item, 256, true);
    divide(grid, RF_GRID_LIGHT_SQUARED, item, 32768, true);
}

static void blur_plane(void *context, int item, int worker)
{
    const struct rf_light_grid *grid = context;
    const struct rf_grid_plane *plane = &grid->plane[item];

    (void)worker;
    for (int k = plane->first; k < plane->last; k++)
        rf_pyramid_halve(plane->scale[k], rf_grid_size(grid->width, k),
                         rf_grid_size(grid->height, k), plane->scale[k + 1]);
    for (int k = plane->first; k <= plane->last && !rf_cancelled(grid->exec); k++)
        rf_pyramid_smooth(plane->scale[k], rf_grid_size(grid->width, k),
                          rf_grid_size(grid->height, k));
}

/* Makes the products of scale 1 with the glare g = sum of C_k / 2^(k - 1), which is added up from
 * the widest scale on. */
static void add_glare(const struct rf_light_grid *grid)
{
    float *const *clipped = grid->plane[RF_GRID_CLIPPED].scale;
    float *const *glare = grid->plane[RF_GRID_GLARE].scale;
    const float *dark = grid->plane[RF_GRID_DARK].scale[1];
    const float *light = grid->plane[RF_GRID_LIGHT].scale[1];
    float *squared = grid->plane[RF_GRID_GLARE_SQUARED].scale[1];
    float *both = grid->plane[RF_GRID_GLARE_LIGHT].scale[1];
    const int last = grid->plane[RF_GRID_GLARE].last;
    const int cells = rf_grid_size(grid->width, 1) * rf_grid_size(grid->height, 1);

    for (int k = last; k >= 1; k--) {
        const int across = rf_grid_size(grid->width, k), down = rf_grid_size(grid->height, k);

        memcpy(glare[k], clipped[k], (size_t)across * (size_t)down * sizeof(float));
        if (k < last)
            rf_pyramid_add_doubled(glare[k + 1], 0.5f, across, down, glare[k]);
    }
    for (int i = 0; i < cells; i++) {
        const float g = glare[1][i];

        glare[1][i] = dark[i] * g;
        squared[i] = dark[i] * g * g;
        both[i] = light[i] * g;
    }
}

static void blur_glare(void *context, int item, int worker)
{
    blur_plane(context, RF_GRID_DARK + item, worker);
}

static bool any_clipped(const struct rf_light_grid *grid)
{
    for (int y = 0; y < grid->photo->height; y++)
        if (rf_grid_may_be_clipped(grid, 0, y, grid->photo->width))
            return true;
    return false;
}

static double mean_of(const float *at, int count)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += (double)at[i];
    return sum / count;
}

bool rf_light_grid_measure(struct rf_light_grid *grid, const struct rf_transfer *linear)
{
    const int down = rf_grid_size(grid->height, 1);

    set_tables(grid, linear);
    if (!any_clipped(grid))
        return false;
    rf_pool_run(grid->exec->pool, measure_rows, grid, down);
    if (rf_cancelled(grid->exec))
        return false;
    grid->mean_log =
        mean_of(grid->plane[RF_GRID_LOG].scale[1], rf_grid_size(grid->width, 1) * down) - 9;
    rf_pool_run(grid->exec->pool, blur_plane, grid, RF_GRID_DARK);
    if (rf_cancelled(grid->exec))
        return false;
    add_glare(grid);
    rf_pool_run(grid->exec->pool, blur_glare, grid, RF_GRID_MEASURES - RF_GRID_DARK);
    return !rf_cancelled(grid->exec);
}

struct rf_grid_row rf_grid_row(const struct rf_light_grid *grid, int scale, int y)
{
    const int across = rf_grid_size(grid->width, scale), down = rf_grid_size(grid->height, scale);
    const float unit = 1 / (float)(1 << scale), v = ((float)y + 0.5f) * unit - 0.5f;
    const int y0 = v < 0 ? -1 : (int)v;

    return (struct rf_grid_row){
        scale,
        across,
        unit,
        (ptrdiff_t)rf_larger(y0, 0) * across,
        (ptrdiff_t)rf_smaller(y0 + 1, down - 1) * across,
        v - (float)y0,
    };
}

struct rf_grid_place rf_grid_place(const struct rf_light_grid *grid, int scale, int x, int y)
{
    const struct rf_grid_row row = rf_grid_row(grid, scale, y);

    return rf_grid_place_in(&row, x);
}
