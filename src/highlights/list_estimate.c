/* list_estimate.c: lists the pixels that have lost much of their light to clipping, row by row, as
 * highlights. */
#include <math.h>
#include <string.h>

#include "highlights/estimate.h"
#include "highlights/highlights.h"
#include "support/compare.h"

enum { LEAST = RF_LIGHT_MAX / 16 };

struct listing {
    const struct rf_estimate *estimate;
    struct rf_highlights *highlights;
    float least; /* Q12: a pixel that has lost less is none */
    bool counts; /* runs are counted, as the capacity of their part, and not listed */
};

/* A row of the photo, with the run in the making. */
struct row {
    const struct listing *listing;
    struct rf_estimate_row estimate;
    int y, cell; /* the row of cells that it lies in */
    int hue_of;  /* the cell that the hue is of */
    float known; /* The hue counts by this share, 0 to 1. */
    float hue[3];
    struct rf_highlight run;
    float light[3]; /* Q12, of all its pixels */
};

/* How near to white a channel is: 0 up to half of it, 1 from 0.95 on. */
static float nearness_to_white(int light)
{
    const float t = ((float)light / RF_LIGHT_MAX - 0.5f) * (1 / 0.45f);

    return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

/* How near to white the second brightest channel is. Where one channel alone is clipped, a petal or
 * a painted wall is as likely as a light source. */
static float whiteness(const int colour[3])
{
    const int most = rf_larger(colour[0], rf_larger(colour[1], colour[2]));
    const int least = rf_smaller(colour[0], rf_smaller(colour[1], colour[2]));

    return nearness_to_white(colour[0] + colour[1] + colour[2] - most - least);
}

/* How much light a pixel has lost, as times its own; 0: hardly any. */
static float gain_at(const struct row *row, const int colour[3], int x)
{
    const struct rf_grid_tables *tables = row->estimate.grid->tables;
    const int most = rf_larger(colour[0], rf_larger(colour[1], colour[2]));
    float gain, white;

    if (most <= tables->clipped)
        return 0;
    white = whiteness(colour);
    if (white <= 0)
        return 0;
    gain = rf_estimate_at(&row->estimate, x) * white * ((float)tables->soft[most] * (1 / 256.0f));
    return gain * (float)most < row->listing->least ? 0 : gain;
}

/* Adds the light that a pixel has lost, Q12. The lens has spread the highlight's own light around
 * it, so the whole light has the hue of what is around the clipped pixels, as far as that is its
 * own, and what of that the pixel does not show is lost: of a warm lamp that is clipped to white,
 * which holds too much blue, hardly any blue. Of a pixel that has lost little, the hue changes
 * little. A channel far below white has lost none. The light that a fixed gain adds has half that
 * hue, and half that of the pixel. */
static void add_light(struct row *row, const int colour[3], float gain, int cell)
{
    const bool fixed = !(row->listing->estimate->scale > 0);
    const float share = fixed ? 0.5f * gain : fminf(1 + gain, 2 * gain);
    const float luminance =
        (218 * (float)colour[0] + 732 * (float)colour[1] + 74 * (float)colour[2]) * (1 / 1024.0f);

    if (row->hue_of != cell)
        row->known = rf_skirt_hue(row->estimate.grid, cell, row->cell, row->hue);
    row->hue_of = cell;
    for (int c = 0; c < 3; c++) {
        const float own = (float)colour[c];
        const float toward = row->known * (luminance * row->hue[c] - own);
        const float lost = gain * own + share * toward;

        if (lost > 0)
            row->light[c] += fixed ? lost : lost * nearness_to_white(colour[c]);
    }
}

static void close_run(struct row *row)
{
    struct rf_highlight_list *list = &row->listing->highlights->part[row->y / RF_HIGHLIGHT_ROWS];

    if (row->run.count && row->listing->counts) {
        list->capacity++;
    } else if (row->run.count && list->count < list->capacity) {
        for (int c = 0; c < 3; c++) {
            /* A gain of RF_MOST_GAIN adds a third of this RF_MOST_GAIN - 1 times. */
            const float each = row->light[c] * (3.0f / (RF_MOST_GAIN - 1)) / row->run.count;

            row->run.boost[c] =
                (uint16_t)(each < 3 * RF_LIGHT_MAX ? each + 0.5f : 3.0f * RF_LIGHT_MAX);
        }
        list->run[list->count++] = row->run;
    }
    memset(&row->run, 0, sizeof row->run);
    memset(row->light, 0, sizeof row->light);
}

static void list_pixel(struct row *row, const int colour[3], int x)
{
    const struct rf_light_grid *grid = row->estimate.grid;
    const float gain = gain_at(row, colour, x);
    int cell;

    if (row->run.count && (row->run.x + row->run.count != x || row->run.count == RF_HIGHLIGHT_RUN))
        close_run(row);
    if (gain == 0)
        return;
    if (!row->run.count) {
        row->run.x = (uint16_t)x;
        row->run.y = (uint16_t)row->y;
    }
    row->run.count++;
    if (row->listing->counts)
        return;
    cell = rf_grid_cell(x, grid->photo->width, grid->width);
    if (row->run.count == 1)
        row->run.size = (uint8_t)rf_clipped_size(grid, cell, row->cell);
    add_light(row, colour, gain, cell);
}

/* Lists those of the pixels from x to end - 1 that are highlights. */
static void list_pixels(struct row *row, int x, int end)
{
    const struct rf_light_grid *grid = row->estimate.grid;
    uint8_t rgb[3 * RF_GRID_RUN];

    for (int n; x < end; x += n) {
        struct rf_grid_pixels pixels;

        n = rf_smaller(end - x, RF_GRID_RUN);
        if (!rf_grid_may_be_clipped(grid, x, row->y, n))
            continue;
        pixels = rf_grid_pixels(grid, x, row->y, n, rgb);
        for (int i = 0; i < n; i++) {
            int colour[3];

            rf_grid_colour(&pixels, i, colour);
            list_pixel(row, colour, x + i);
        }
    }
}

/* Lists those of a row that lie where enough light was lost. */
static void list_row(const struct listing *listing, int y)
{
    const struct rf_light_grid *grid = listing->estimate->grid;
    const int *const first = grid->tables->first;
    struct row row = {.listing = listing,
                      .estimate = rf_estimate_row(listing->estimate, y),
                      .y = y,
                      .cell = rf_grid_cell(y, grid->photo->height, grid->height),
                      .hue_of = -1};
    uint8_t reaches[RF_GRID_SIDE];

    if (!rf_estimate_reaches(&row.estimate, listing->least / RF_LIGHT_MAX, reaches))
        return;
    for (int x = 0, end; x < grid->width; x = end) {
        for (end = x + 1; end < grid->width && reaches[end] == reaches[x];)
            end++;
        if (reaches[x]) /* from an even pixel on, as chroma may want it */
            list_pixels(&row, first[x] & ~1, first[end]);
    }
    close_run(&row);
}

/* A part of the list. */
static void list_part(void *context, int item, int worker)
{
    const struct listing *listing = context;
    const struct rf_light_grid *grid = listing->estimate->grid;
    const int end = rf_smaller((item + 1) * RF_HIGHLIGHT_ROWS, grid->photo->height);

    (void)worker;
    if (!listing->counts && !listing->highlights->part[item].capacity)
        return;
    for (int y = item * RF_HIGHLIGHT_ROWS; y < end && !rf_cancelled(grid->exec); y++)
        list_row(listing, y);
}

/* Counts the runs of each part. The darkest are left out, until there is room for the others. */
static void share_room(struct listing *listing)
{
    const struct rf_light_grid *grid = listing->estimate->grid;
    const int parts = (grid->photo->height + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS;
    bool fits;

    listing->counts = true;
    do {
        for (int part = 0; part < parts; part++)
            listing->highlights->part[part].capacity = 0;
        rf_pool_run(grid->exec->pool, list_part, listing, parts);
        fits = rf_share_room(listing->highlights, grid->photo->width, grid->photo->height);
        listing->least *= 2;
    } while (!fits && listing->least < RF_MOST_GAIN * RF_LIGHT_MAX && !rf_cancelled(grid->exec));
    listing->least /= 2;
    listing->counts = false;
}

void rf_estimate_highlights(struct rf_light_grid *grid, struct rf_arena *arena,
                            const struct rf_transfer *linear, float scale,
                            struct rf_highlights *highlights)
{
    struct rf_estimate estimate = {.grid = grid, .scale = scale};
    struct listing listing = {&estimate, highlights, LEAST, false};
    const int parts = (grid->photo->height + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS;

    rf_clear_highlights(highlights, grid->photo->width, grid->photo->height, false);
    rf_light_grid_lay_out(grid, arena);
    rf_estimate_lay_out(&estimate, arena);
    if (!rf_light_grid_measure(grid, linear))
        return;
    rf_estimate_make(&estimate);
    share_room(&listing);
    rf_pool_run(grid->exec->pool, list_part, &listing, parts);
}
