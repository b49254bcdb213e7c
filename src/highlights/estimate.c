/* estimate.c: an estimate of lost light for each cell that is clipped, and for the pixels between
 * their middles. */
#include "highlights/estimate.h"

#include <math.h>

#include "support/compare.h"

#define LEAST_SKIRT 0.002f
#define SURE_SKIRT  3.0f /* hue is sure where a third of the light around is the skirt */

uint64_t rf_estimate_bytes(int max_width, int max_height)
{
    struct rf_light_grid grid = {.width = rf_smaller(max_width, RF_GRID_SIDE),
                                 .height = rf_smaller(max_height, RF_GRID_SIDE)};
    struct rf_estimate estimate = {.grid = &grid};
    struct rf_arena arena = {NULL, 0};

    rf_estimate_lay_out(&estimate, &arena);
    return rf_light_grid_bytes(max_width, max_height) + arena.used;
}

void rf_estimate_lay_out(struct rf_estimate *estimate, struct rf_arena *arena)
{
    const uint64_t cells = (uint64_t)estimate->grid->width * (uint64_t)estimate->grid->height;

    estimate->lost = rf_arena_take(arena, cells, sizeof *estimate->lost);
}

struct job {
    const struct rf_estimate *estimate;
    float scale;
    bool fixed; /* gain */
};

static void estimate_row(void *context, int item, int worker)
{
    const struct job *job = context;
    const struct rf_light_grid *grid = job->estimate->grid;
    float *const lost = job->estimate->lost + (ptrdiff_t)item * grid->width;

    (void)worker;
    if (rf_cancelled(grid->exec))
        return;
    rf_estimate_cells(grid, item, job->fixed, lost);
    for (int x = 0; x < grid->width; x++)
        lost[x] *= job->scale;
}

void rf_estimate_make(const struct rf_estimate *estimate)
{
    const bool fixed = !(estimate->scale > 0);
    struct job job = {estimate, fixed ? 1 : estimate->scale, fixed};

    rf_pool_run(estimate->grid->exec->pool, estimate_row, &job, estimate->grid->height);
}

/* The cells before and after the middle of a pixel along a side, and how far it is between them. */
struct between {
    int cell[2];
    float part;
};

static struct between between(int i, int pixels, int cells)
{
    const float u = ((float)i + 0.5f) * (float)cells / (float)pixels - 0.5f;
    const int before = u < 0 ? -1 : (int)u;

    return (struct between){{rf_larger(before, 0), rf_smaller(before + 1, cells - 1)},
                            u - (float)before};
}

struct rf_estimate_row rf_estimate_row(const struct rf_estimate *estimate, int y)
{
    const struct rf_light_grid *grid = estimate->grid;
    const struct between rows = between(y, grid->photo->height, grid->height);
    struct rf_estimate_row row = {.grid = grid, .low = rows.part};

    for (int j = 0; j < 2; j++)
        row.lost[j] = estimate->lost + (ptrdiff_t)rows.cell[j] * grid->width;
    return row;
}

float rf_estimate_at(const struct rf_estimate_row *row, int x)
{
    const struct between columns = between(x, row->grid->photo->width, row->grid->width);
    float sum = 0, weight = 0;

    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const float value = row->lost[j][columns.cell[i]];
            const float own = (i ? columns.part : 1 - columns.part) * (j ? row->low : 1 - row->low);

            if (value >= 0) {
                sum += own * value;
                weight += own;
            }
        }
    return weight > 0 ? sum / weight : 0;
}

bool rf_estimate_reaches(const struct rf_estimate_row *row, float least,
                         uint8_t reaches[RF_GRID_SIDE])
{
    const float *const above = row->lost[0], *const below = row->lost[1];
    const int width = row->grid->width;
    const float most = least * 0.999f; /* a mean of four may round up */
    uint8_t own[RF_GRID_SIDE + 2] = {0}, any = 0;

    for (int x = 0; x < width; x++)
        own[x + 1] = (above[x] >= most) | (below[x] >= most);
    for (int x = 0; x < width; x++) {
        reaches[x] = own[x] | own[x + 1] | own[x + 2];
        any |= reaches[x];
    }
    return any;
}

/* Whichever of two is nearer to 0; 0 if their signs differ. */
static float lesser(float a, float b)
{
    return fmaxf(fminf(a, b), 0) + fminf(fmaxf(a, b), 0);
}

float rf_skirt_hue(const struct rf_light_grid *grid, int x, int y, float hue[3])
{
    static const float of_luminance[3] = {218.0f / 1024, 732.0f / 1024, 74.0f / 1024};
    const struct rf_grid_place at = rf_grid_place(grid, 1, x, y);
    const struct rf_grid_place far = rf_grid_place(grid, 3, x, y);
    float near[3], skirt[3], around = 0, luminance = 0;

    for (int c = 0; c < 3; c++) {
        near[c] = rf_unclipped_at(grid, RF_GRID_RED + (unsigned)c, &at);
        skirt[c] = near[c] - rf_unclipped_at(grid, RF_GRID_RED + (unsigned)c, &far);
        around += of_luminance[c] * near[c];
        luminance += of_luminance[c] * skirt[c];
    }
    if (luminance <= LEAST_SKIRT)
        return 0;
    for (int c = 0; c < 3; c++)
        hue[c] = 1 + lesser(skirt[c] / luminance - 1, near[c] / around - 1);
    return fminf(SURE_SKIRT * (luminance - LEAST_SKIRT) / around, 1);
}

int rf_clipped_size(const struct rf_light_grid *grid, int x, int y)
{
    const float cell = (float)rf_larger(grid->photo->width, grid->photo->height) /
                       (float)rf_larger(grid->width, grid->height);
    int scale = 0;

    for (; scale < RF_GRID_SCALES - 1; scale++) {
        const struct rf_grid_place place = rf_grid_place(grid, scale, x, y);

        if (rf_grid_at(grid, RF_GRID_CLIPPED, &place) <= 0.5f)
            break;
    }
    return rf_smaller((int)(cell * (float)(1 << scale) + 0.5f), UINT8_MAX);
}
