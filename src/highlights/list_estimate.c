/* list_estimate.c: lists the pixels that have lost much of their light to clipping, row by row, as
 * highlights. */
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

/* A run in the making. */
struct open {
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
static float gain_at(const struct listing *listing, const int colour[3], int x, int y)
{
    const struct rf_estimate *estimate = listing->estimate;
    const struct rf_grid_tables *tables = estimate->grid->tables;
    const int most = rf_larger(colour[0], rf_larger(colour[1], colour[2]));
    float gain, white;

    if (most <= tables->clipped)
        return 0;
    white = whiteness(colour);
    if (white <= 0)
        return 0;
    gain = rf_estimate_at(estimate, x, y) * white * ((float)tables->soft[most] * (1 / 256.0f));
    return gain * (float)most < listing->least ? 0 : gain;
}

/* Adds the light that a pixel has lost, Q12. Half of it has its own hue, half that of what is
 * around the clipped pixels; a channel far below white has lost none, whatever a fixed gain adds to
 * it. */
static void add_light(const struct rf_estimate *estimate, const int colour[3], float gain, int x,
                      int y, float light[3])
{
    const struct rf_light_grid *grid = estimate->grid;
    const int cx = rf_grid_cell(x, grid->photo->width, grid->width);
    const int cy = rf_grid_cell(y, grid->photo->height, grid->height);
    const float luminance =
        (218 * (float)colour[0] + 732 * (float)colour[1] + 74 * (float)colour[2]) * (1 / 1024.0f);
    float hue[3];
    const bool mixes = rf_skirt_hue(grid, cx, cy, hue);

    for (int c = 0; c < 3; c++) {
        const float own = (float)colour[c];
        const float lost = mixes ? gain * 0.5f * (own + luminance * hue[c]) : gain * own;

        light[c] += estimate->scale > 0 ? lost * nearness_to_white(colour[c]) : lost;
    }
}

static void close_run(const struct listing *listing, struct open *open)
{
    struct rf_highlight_list *list = &listing->highlights->part[open->run.y / RF_HIGHLIGHT_ROWS];

    if (open->run.count && listing->counts) {
        list->capacity++;
    } else if (open->run.count && list->count < list->capacity) {
        for (int c = 0; c < 3; c++) {
            /* A gain of RF_MOST_GAIN adds a third of this RF_MOST_GAIN - 1 times. */
            const float each = open->light[c] * (3.0f / (RF_MOST_GAIN - 1)) / open->run.count;

            open->run.boost[c] =
                (uint16_t)(each < 3 * RF_LIGHT_MAX ? each + 0.5f : 3.0f * RF_LIGHT_MAX);
        }
        list->run[list->count++] = open->run;
    }
    memset(open, 0, sizeof *open);
}

static void list_pixel(const struct listing *listing, const int colour[3], struct open *open, int x,
                       int y)
{
    const struct rf_light_grid *grid = listing->estimate->grid;
    const int width = grid->photo->width;
    float gain;

    if (open->run.count &&
        (open->run.x + open->run.count != x || open->run.count == RF_HIGHLIGHT_RUN))
        close_run(listing, open);
    gain = gain_at(listing, colour, x, y);
    if (gain == 0)
        return;
    if (!open->run.count) {
        open->run.x = (uint16_t)x;
        open->run.y = (uint16_t)y;
        open->run.size =
            (uint8_t)rf_clipped_size(grid, rf_grid_cell(x, width, grid->width),
                                     rf_grid_cell(y, grid->photo->height, grid->height));
    }
    open->run.count++;
    if (!listing->counts)
        add_light(listing->estimate, colour, gain, x, y, open->light);
}

static void list_pixels(const struct listing *listing, struct open *open, int x, int y, int n)
{
    uint8_t rgb[3 * RF_GRID_RUN];
    const struct rf_grid_pixels pixels = rf_grid_pixels(listing->estimate->grid, x, y, n, rgb);

    for (int i = 0; i < n; i++) {
        int colour[3];

        rf_grid_colour(&pixels, i, colour);
        list_pixel(listing, colour, open, x + i, y);
    }
}

/* A part of the list. */
static void list_part(void *context, int item, int worker)
{
    const struct listing *listing = context;
    const struct rf_light_grid *grid = listing->estimate->grid;
    const int width = grid->photo->width;
    const int end = rf_smaller((item + 1) * RF_HIGHLIGHT_ROWS, grid->photo->height);

    (void)worker;
    if (!listing->counts && !listing->highlights->part[item].capacity)
        return;
    for (int y = item * RF_HIGHLIGHT_ROWS; y < end && !rf_cancelled(grid->exec); y++) {
        struct open open = {.run = {.count = 0}};

        for (int x = 0; x < width; x += RF_GRID_RUN) {
            const int n = rf_smaller(width - x, RF_GRID_RUN);

            if (rf_grid_may_be_clipped(grid, x, y, n))
                list_pixels(listing, &open, x, y, n);
        }
        close_run(listing, &open);
    }
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
