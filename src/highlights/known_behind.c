/* known_behind.c: what lies behind the foreground is as bright as what is seen beside it, also
 * where that is brighter than white, as a sky may be. A highlight is not taken to go on there: it
 * would be spread as wide as what hides it.
 */
#include <assert.h>

#include "background/pyramid.h"
#include "highlights/in_window.h"
#include "highlights/known.h"
#include "kernels/kernels.h"
#include "support/compare.h"

/* The pyramid holds as much, and means do. */
enum { MOST = 4 * RF_LIGHT_MAX };
static_assert(4 * MOST + 2 <= UINT16_MAX, "four children of push fit 16 bits");

/* The farthest disparities, of 65535. */
enum { FAR = 4096 };

struct behind {
    const struct rf_highlight_window *window;
    const struct rf_focus_plan *plan;
    struct rf_disparity_q16 disparity;
    const struct rf_level *fine, *coarse;
    int apart; /* as of the pyramid */
};

/* Light above white of the pixels of a tile, Q12; 0 where they have none. */
struct tile {
    struct rf_rect at;
    int excess[3][RF_TILE * RF_TILE];
    int16_t map_blur[RF_TILE * RF_TILE]; /* by the map's disparity, as it is stored */
};

static int place_of(const struct tile *tile, int x, int y)
{
    return (y - tile->at.y0) * RF_TILE + x - tile->at.x0;
}

/* Whether a pixel is behind the focus, or as far as any, and hides nothing that is farther. Other
 * bright things hide what is dark. A silhouette that was given the depth of what is behind it is no
 * more than a mixture. */
static bool is_background(const struct behind *b, const struct tile *tile, int x, int y)
{
    const struct rf_blur_q8 *const own = &b->window->blur, *const background = &b->fine->blur;
    const int blur = own->at[y * own->stride + x];

    return (rf_in_pixels(blur, own->unit) >= RF_KNOWN_FROM ||
            b->disparity.at[y * b->disparity.stride + x] < FAR) &&
           background->at[y * background->stride + x] == blur &&
           tile->map_blur[place_of(tile, x, y)] == blur;
}

static bool is_above(const struct tile *tile, int i)
{
    return tile->excess[0][i] | tile->excess[1][i] | tile->excess[2][i];
}

/* Reads what is listed of a row. */
static void read_listed(const struct behind *b, struct tile *tile, int y)
{
    const struct rf_viewport *const view = b->window->view;
    const int row = view->y0 + y, x0 = view->x0 + tile->at.x0, x1 = view->x0 + tile->at.x1;
    const struct rf_highlight_list *const list =
        &b->window->highlights->part[row / RF_HIGHLIGHT_ROWS];
    struct rf_highlight *const end = list->run + list->count;
    const struct rf_highlight *run = rf_first_run(list->run, end, x0, row);

    for (; run < end && run->y == row && run->x < x1; run++)
        for (int i = 0; i < run->count && run->x + i < x1; i++)
            for (int c = 0; c < 3; c++)
                tile->excess[c][place_of(tile, run->x + i - view->x0, y)] =
                    run->boost[c] * RF_KNOWN_UNIT;
}

/* Reads what is left to the rays of a row. */
static void read_left(const struct behind *b, struct tile *tile, int y)
{
    const struct rf_viewport *const view = b->window->view;

    for (int x = tile->at.x0; x < tile->at.x1; x++) {
        int excess[3];

        rf_known_excess(b->window->known, view->x0 + x, view->y0 + y, excess);
        for (int c = 0; c < 3; c++)
            tile->excess[c][place_of(tile, x, y)] = excess[c];
    }
}

static void take_map_blur(const struct behind *b, struct tile *tile)
{
    const struct rf_viewport *const view = b->window->view;

    for (int y = tile->at.y0; y < tile->at.y1; y++)
        rf_focus_row(b->plan, tile->map_blur + place_of(tile, tile->at.x0, y),
                     b->disparity.at + y * b->disparity.stride + tile->at.x0,
                     view->x0 + tile->at.x0, view->y0 + y, tile->at.x1 - tile->at.x0);
}

static bool has_light(const struct tile *tile)
{
    int any = 0;

    for (int i = 0; i < RF_TILE * RF_TILE; i++)
        any |= is_above(tile, i);
    return any;
}

/* Whether three quarters of the background in a tile are above white. */
static bool is_wide(const struct behind *b, const struct tile *tile)
{
    int above = 0, all = 0;

    for (int y = tile->at.y0; y < tile->at.y1; y++)
        for (int x = tile->at.x0; x < tile->at.x1; x++)
            if (is_background(b, tile, x, y)) {
                above += is_above(tile, place_of(tile, x, y));
                all++;
            }
    return above > 0 && 4 * above >= 3 * all;
}

/* Whether a pixel counts for the mean light of its parent: rf_background_push(). */
static bool counts(const struct behind *b, int x, int y)
{
    const int own = b->fine->blur.at[y * b->fine->blur.stride + x];
    const int parent = b->coarse->blur.at[y / 2 * b->coarse->blur.stride + x / 2];

    return own != RF_NO_BLUR && parent - own <= b->apart;
}

/* How many of the pixels that (x, y) has one parent with count for it. */
static int count_all(const struct behind *b, int x, int y)
{
    int count = 0;

    for (int v = y & ~1; v <= (y | 1) && v < b->fine->height; v++)
        for (int u = x & ~1; u <= (x | 1) && u < b->fine->width; u++)
            count += counts(b, u, v);
    return count;
}

/* Adds light above white to the means that the parents of a tile's pixels have. */
static void add_to_parents(const struct behind *b, const struct tile *tile)
{
    const struct rf_light_q12 *const light = &b->coarse->light;

    for (int y = tile->at.y0; y < tile->at.y1; y++)
        for (int x = tile->at.x0; x < tile->at.x1; x++) {
            const int i = place_of(tile, x, y);
            const ptrdiff_t at = y / 2 * light->stride + x / 2;
            int count;

            if (!is_above(tile, i) || !is_background(b, tile, x, y) || !counts(b, x, y))
                continue;
            count = count_all(b, x, y);
            for (int c = 0; c < 3; c++) {
                const int more = rf_smaller(tile->excess[c][i], MOST);

                light->channel[c][at] =
                    (uint16_t)rf_smaller(light->channel[c][at] + (more + count / 2) / count, MOST);
            }
        }
}

void rf_push_known(const struct rf_highlight_window *window, const struct rf_focus_plan *plan,
                   struct rf_disparity_q16 disparity, const struct rf_pyramid *pyramid, int band)
{
    const struct behind b = {window,        plan, disparity, &pyramid->level[0], &pyramid->level[1],
                             pyramid->apart};

    for (int tx = 0; tx < window->view->tiles_x && pyramid->levels > 0; tx++) {
        const bool is_left = rf_known_is_left(window, tx, band);
        struct tile tile = {.at = {tx * RF_TILE, rf_band_start(band),
                                   rf_smaller((tx + 1) * RF_TILE, window->view->width),
                                   rf_band_end(window->view, band)}};

        for (int y = tile.at.y0; y < tile.at.y1; y++)
            (is_left ? read_left : read_listed)(&b, &tile, y);
        if (!has_light(&tile))
            continue;
        take_map_blur(&b, &tile);
        if (is_wide(&b, &tile))
            add_to_parents(&b, &tile);
    }
}

void rf_note_behind(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    struct rf_light_q12 behind, int band)
{
    const struct rf_viewport *const view = window->view;

    for (int tx = 0; tx < view->tiles_x; tx++) {
        const int x = tx * RF_TILE, wide = rf_smaller(RF_TILE, view->width - x);
        uint16_t *const brightest = &window->bins[band * view->tiles_x + tx].brightest;

        for (int y = rf_band_start(band); y < rf_band_end(view, band); y++) {
            const ptrdiff_t at = y * behind.stride + x;
            const uint16_t here = exec->kernels->brightest(
                behind.channel[0] + at, behind.channel[1] + at, behind.channel[2] + at, wide);

            *brightest = here > *brightest ? here : *brightest;
        }
    }
}
