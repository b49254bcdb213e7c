/* coverage.c: splats thin structures that are far before the focus into the coverage layer. */
#include "thin/coverage.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"
#include "thin/mixture.h"

enum { CELLS = RF_TILE / RF_COVERAGE_CELL };
static_assert(CELLS * CELLS == RF_COVERAGE_SOURCES, "a source for each cell of a tile");

uint64_t rf_coverage_source_bytes(void)
{
    return sizeof(struct rf_coverage_source);
}

void rf_lay_out_coverage(struct rf_coverage *coverage, struct rf_arena *arena, int max_width,
                         int max_height)
{
    const uint64_t across = (uint64_t)(max_width + RF_TILE - 1) / RF_TILE;
    const uint64_t down = (uint64_t)(max_height + RF_TILE - 1) / RF_TILE;

    coverage->stride = (int)(across * CELLS) + 1;
    coverage->cell =
        rf_arena_take(arena, (uint64_t)coverage->stride * down * CELLS, sizeof *coverage->cell);
    coverage->sources = rf_arena_take(arena, down, sizeof *coverage->sources);
    coverage->choice = rf_arena_take(arena, across * down, sizeof *coverage->choice);
    coverage->swapped = rf_arena_take(arena, down, sizeof *coverage->swapped);
}

/* Sums over the pixels of a cell. */
struct sum {
    int32_t light[4]; /* sums of alpha N (three channels) and of alpha, 4096 = 1 */
    int32_t blur, weight;
    int32_t x, y; /* alpha times a pixel's place in its cell is added up */
};

/* Adds up the splatted mixtures of a tile by cells. */
static void add_tile(const struct rf_thin_pass *t, int tx, int ty, struct sum sum[CELLS * CELLS])
{
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);
    const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, ty);

    for (uint32_t i = 0; i < count; i++, thin++) {
        const int x = thin->at % RF_TILE, y = thin->at / RF_TILE;
        const ptrdiff_t at = (ty * RF_TILE + y) * t->view->stride + tx * RF_TILE + x;
        struct sum *cell = &sum[y / RF_COVERAGE_CELL * CELLS + x / RF_COVERAGE_CELL];

        if (!rf_has_bit(choice->splat, i))
            continue;
        for (int c = 0; c < 3; c++)
            cell->light[c] +=
                t->light.channel[c][at] - ((255 - thin->alpha) * thin->light[c] + 127) / 255;
        cell->light[3] += (4096 * thin->alpha + 127) / 255;
        cell->weight += thin->alpha;
        cell->blur -= thin->alpha * rf_near_blur(t, thin, tx, ty);
        cell->x += thin->alpha * (x % RF_COVERAGE_CELL);
        cell->y += thin->alpha * (y % RF_COVERAGE_CELL);
    }
}

/* Half the chord of a disc of radius 1 at n / 32 from its middle, Q15: sqrt(1 - (n /
 * 32)^2). */
static const uint16_t half_chord[33] = {
    32768, 32752, 32704, 32624, 32511, 32366, 32187, 31974, 31727, 31445, 31127,
    30771, 30377, 29942, 29466, 28945, 28378, 27762, 27092, 26367, 25580, 24725,
    23796, 22783, 21674, 20454, 19102, 17588, 15864, 13852, 11403, 8128,  0};

static int chord(int dy, int radius) /* Q8 both, below 2^16 */
{
    const uint32_t at = ((uint32_t)dy << 13) / (uint32_t)radius; /* Q8 of 1/32 */
    const uint32_t i = at >> 8, part = at & 255;

    if (i >= 32)
        return 0;
    return (int)(((uint64_t)(half_chord[i] * (256 - part) + half_chord[i + 1] * part) *
                  (uint32_t)radius) >>
                 23);
}

/* The first and the last row of cells whose middle is within a disc around y. */
static int first_row(int y, int radius)
{
    return (y - radius + 127) >> 8;
}

static int last_row(int y, int radius)
{
    return (y + radius - 128) >> 8;
}

/* Half the length of a disc's row of cells. */
static int half_row(int row, int y, int radius)
{
    return chord(abs(row * 256 + 128 - y), radius);
}

/* Divides the light and the coverage of a cell among the cells of its disc: there are as many of
 * these as the disc's rows are long together. */
static void share(const int32_t light[4], int y, int radius, int32_t each[4])
{
    int64_t length = 0;

    for (int row = first_row(y, radius); row <= last_row(y, radius); row++)
        length += half_row(row, y, radius);
    static_assert((INT64_C(16) * 4096 << (RF_COVERAGE_SHIFT + 8 - 4)) / (2 * 256) <= 1 << 25,
                  "half of one a cell, of discs of a cell of radius");
    for (int c = 0; c < 4; c++) /* sums are of pixels, 16 a cell */
        each[c] =
            (int32_t)(((int64_t)light[c] * (1 << (RF_COVERAGE_SHIFT + 8 - 4))) / (2 * length));
}

/* The radius on the layer of a disc that is to look as wide as one of this radius, whose variance
 * is radius^2 / 4. The layer widens discs: the ends of a row are parts of cells (1/12 of a cell
 * squared of variance, across alone), and between cells it is interpolated (1/6 both ways). */
static int narrow(int radius) /* Q8, cells */
{
    const int64_t square = (int64_t)radius * radius - 5 * 65536 / 6;

    return square > 256 * 256 ? (int)sqrt((double)square) : 256;
}

static void set_centre(struct rf_coverage_source *source, int cell_x, int cell_y,
                       const struct sum *sum)
{
    const int pixel = 256 / RF_COVERAGE_CELL;

    source->x = cell_x * 256 + (sum->x * pixel / sum->weight) + pixel / 2;
    source->y = cell_y * 256 + (sum->y * pixel / sum->weight) + pixel / 2;
}

static void collect_band(void *context, int ty, int worker)
{
    const struct rf_thin_pass *t = context;
    struct rf_coverage_source *out =
        t->coverage->source + (ptrdiff_t)ty * t->view->tiles_x * CELLS * CELLS;
    uint32_t sources = 0;

    (void)worker;
    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        struct sum sum[CELLS * CELLS] = {0};

        if (!rf_thin_choice_of(t, tx, ty)->splats)
            continue;
        add_tile(t, tx, ty, sum);
        for (int i = 0; i < CELLS * CELLS; i++) {
            if (!sum[i].weight)
                continue;
            set_centre(&out[sources], tx * CELLS + i % CELLS, ty * CELLS + i / CELLS, &sum[i]);
            out[sources].radius =
                narrow(rf_smaller(sum[i].blur / sum[i].weight * t->disc_scale >> 10, UINT16_MAX));
            share(sum[i].light, out[sources].y, out[sources].radius, out[sources].each);
            sources++;
        }
    }
    t->coverage->sources[ty] = sources;
}

/* Adds v, or takes it away, from cell x on, Q8. */
static void step(int32_t (*row)[4], int cells, int x, const int32_t v[4], int32_t sign)
{
    const int i = x < 0 ? 0 : x >> 8, part = x < 0 ? 0 : x & 255;

    if (i >= cells)
        return;
    for (int c = 0; c < 4; c++) { /* v part / 256 would not fit */
        const int32_t later = (v[c] >> 8) * part + ((v[c] & 255) * part >> 8);

        row[i][c] += sign * (v[c] - later);
        row[i + 1][c] += sign * later;
    }
}

/* A disc in rows from `first` to `end` - 1. */
static void draw(const struct rf_thin_pass *t, int x, int y, const struct rf_coverage_source *s,
                 int first, int end)
{
    const int cells = t->view->tiles_x * CELLS;

    first = rf_larger(first, first_row(y, s->radius));
    end = rf_smaller(end, last_row(y, s->radius) + 1);
    for (int row = first; row < end; row++) {
        const int half = half_row(row, y, s->radius);
        int32_t(*const to)[4] = t->coverage->cell + (size_t)row * t->coverage->stride;

        step(to, cells, x - half, s->each, 1);
        step(to, cells, x + half, s->each, -1);
    }
}

/* Beyond the picture's sides it goes on as its reflection. */
static void draw_reflected(const struct rf_thin_pass *t, const struct rf_coverage_source *s,
                           int first, int end)
{
    const int right = (t->view->width + RF_COVERAGE_CELL - 1) / RF_COVERAGE_CELL * 256;
    const int below = (t->view->height + RF_COVERAGE_CELL - 1) / RF_COVERAGE_CELL * 256;
    const int x[] = {s->x, -s->x, 2 * right - s->x};
    const int y[] = {s->y, -s->y, 2 * below - s->y};

    for (int j = 0; j < 3; j++) {
        if (last_row(y[j], s->radius) < first || first_row(y[j], s->radius) >= end)
            continue;
        for (int i = 0; i < 3; i++)
            if (x[i] + s->radius > 0 && x[i] - s->radius < right)
                draw(t, x[i], y[j], s, first, end);
    }
}

static void draw_band(void *context, int band, int worker)
{
    const struct rf_thin_pass *t = context;
    const int reach = (t->view->pad + RF_TILE) / RF_TILE + 1;
    const int first = band * CELLS, end = first + CELLS;

    (void)worker;
    memset(t->coverage->cell + (size_t)first * (size_t)t->coverage->stride, 0,
           (size_t)CELLS * (size_t)t->coverage->stride * sizeof *t->coverage->cell);
    for (int ty = band - reach; ty <= band + reach; ty++) {
        const struct rf_coverage_source *s =
            t->coverage->source + (ptrdiff_t)ty * t->view->tiles_x * CELLS * CELLS;

        if (ty < 0 || ty >= t->view->tiles_y)
            continue;
        for (uint32_t i = 0; i < t->coverage->sources[ty]; i++)
            draw_reflected(t, &s[i], first, end);
    }
    for (int y = first; y < end; y++) {
        int32_t(*row)[4] = t->coverage->cell + (ptrdiff_t)y * t->coverage->stride;

        for (int x = 1; x < t->view->tiles_x * CELLS; x++)
            for (int c = 0; c < 4; c++)
                row[x][c] += row[x - 1][c];
    }
}

void rf_coverage_splat(const struct rf_thin_pass *t)
{
    rf_pool_run(t->exec->pool, collect_band, (void *)t, rf_bands(t->view));
    rf_pool_run(t->exec->pool, draw_band, (void *)t, rf_bands(t->view));
}

/* Cells around a tile; false: nothing is drawn there. */
static bool get_cells(const struct rf_thin_pass *t, int tx, int ty,
                      int32_t part[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4])
{
    const int across = t->view->tiles_x * CELLS, down = t->view->tiles_y * CELLS;
    const bool inside = tx > 0 && tx < t->view->tiles_x - 1;
    int any = 0;

    for (int j = 0; j < RF_COVERAGE_CELLS; j++) {
        const int y = rf_clamp(ty * CELLS + j - 1, 0, down - 1);
        int32_t(*const row)[4] = t->coverage->cell + (ptrdiff_t)y * t->coverage->stride;

        if (inside)
            memcpy(part[j], row[tx * CELLS - 1], sizeof part[j]);
        else
            for (int i = 0; i < RF_COVERAGE_CELLS; i++)
                memcpy(part[j][i], row[rf_clamp(tx * CELLS + i - 1, 0, across - 1)],
                       sizeof part[j][i]);
        for (int i = 0; i < RF_COVERAGE_CELLS; i++)
            any |= part[j][i][3];
    }
    return any >> RF_COVERAGE_SHIFT != 0;
}

bool rf_has_coverage(const struct rf_thin_pass *t, int tx, int ty)
{
    int32_t part[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4];

    return get_cells(t, tx, ty, part);
}

void rf_coverage_over(const struct rf_thin_pass *t, int tx, int ty,
                      uint16_t mean[3][RF_TILE * RF_TILE])
{
    int32_t part[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4];

    if (get_cells(t, tx, ty, part))
        t->exec->kernels->composite_thin((uint16_t *const[3]){mean[0], mean[1], mean[2]}, part);
}
