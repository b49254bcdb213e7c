/* known.c: the light above white of photos that hold it: listed as highlights where there is room
 * for it, and elsewhere, where much of the photo is brighter than white, left to the rays. */
#include "highlights/known.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "highlights/clipped.h"
#include "highlights/in_window.h"
#include "image/border.h"
#include "support/compare.h"

enum {
    LEAST = RF_LIGHT_MAX / 32, /* light above white that counts, Q12 */
    REACH = 3,                 /* pixels that light left to the rays is spread over, each way */
    PATCH = RF_TILE + 2 * REACH,
    ALIKE = 256, /* Q7.8: how much blurs may differ that it is spread over */
    /* The light of `boost`: a gain of RF_KNOWN_GAIN adds a third of it this many times. */
    UNIT = (RF_KNOWN_GAIN - 1) / 3,
};

/* Light above white of pixels in and around a tile, Q12. */
struct patch {
    int excess[3][PATCH * PATCH];
    bool any[PATCH * PATCH]; /* the pixel has some that counts, in any channel */
};

void rf_lay_out_known(struct rf_highlights *highlights, struct rf_arena *arena, int max_width,
                      int max_height)
{
    highlights->by_rays = rf_arena_take(arena, ((uint64_t)max_width + RF_TILE - 1) / RF_TILE,
                                        ((uint64_t)max_height + RF_TILE - 1) / RF_TILE);
}

/* The light above white of a channel, Q12. */
static int excess_of(float exact)
{
    const float light = (exact - 1) * RF_LIGHT_MAX, most = (float)UINT16_MAX * UNIT;

    return light > 0 ? (int)((light < most ? light : most) + 0.5f) : 0;
}

void rf_known_excess(const struct rf_deep *photo, int x, int y, int excess[3])
{
    float exact[3];

    rf_deep_light(photo, x, y, exact);
    for (int c = 0; c < 3; c++)
        excess[c] = excess_of(exact[c]);
}

/* Reads the pixels x0 <= x < x1 of row y. Returns how many are above white. */
static int read_row(const struct rf_deep *photo, struct patch *patch, int at, int x0, int x1, int y)
{
    int count = 0;

    for (int x = x0; x < x1; x++, at++) {
        int excess[3];

        patch->any[at] = false;
        rf_known_excess(photo, x, y, excess);
        for (int c = 0; c < 3; c++) {
            patch->excess[c][at] = excess[c];
            patch->any[at] |= excess[c] > LEAST;
        }
        count += patch->any[at];
    }
    return count;
}

struct listing {
    const struct rf_executor *exec;
    const struct rf_deep *photo;
    struct rf_highlights *highlights;
    int tiles_x;
};

/* The pixels of a tile. */
static struct rf_rect tile_of(const struct rf_deep *photo, int tx, int ty)
{
    return (struct rf_rect){tx * RF_TILE, ty * RF_TILE,
                            rf_smaller((tx + 1) * RF_TILE, photo->image.width),
                            rf_smaller((ty + 1) * RF_TILE, photo->image.height)};
}

/* How many pixels above white lie side by side around one of a tile, in steps of `step`, up to its
 * sides. */
static int extent(const struct patch *patch, int at, int step, int from, int to)
{
    int count = 1;

    for (int i = 1; i <= from && patch->any[at - i * step]; i++)
        count++;
    for (int i = 1; i < to && patch->any[at + i * step]; i++)
        count++;
    return count;
}

static struct rf_highlight run_of(const struct patch *patch, struct rf_rect tile, int x, int y,
                                  int count)
{
    const int at = y * RF_TILE + x, middle = at + count / 2, rows = tile.y1 - tile.y0;
    const int size = rf_smaller(count, extent(patch, middle, RF_TILE, y, rows - y));
    struct rf_highlight run = {
        .x = (uint16_t)(tile.x0 + x),
        .y = (uint16_t)(tile.y0 + y),
        .count = (uint8_t)count,
        .size = (uint8_t)(size < RF_TILE ? size : UINT8_MAX),
    };

    for (int c = 0; c < 3; c++) {
        int64_t sum = 0;

        for (int i = 0; i < count; i++)
            sum += patch->excess[c][at + i];
        run.boost[c] = (uint16_t)((sum + count * UNIT / 2) / (count * UNIT));
    }
    return run;
}

/* How many pixels above white one run has, from pixel `at` on: `most` or less. A run is drawn as if
 * each of its pixels had their mean light: so the brightest is at most 2^`doublings` times as
 * bright as the darkest, white included. */
static int run_length(const struct patch *patch, int at, int most, int doublings)
{
    int count = 0, dark = INT_MAX, bright = 0;

    for (; count < most && patch->any[at + count]; count++) {
        int light = 0;

        for (int c = 0; c < 3; c++)
            light = rf_larger(light, RF_LIGHT_MAX + patch->excess[c][at + count]);
        dark = rf_smaller(dark, light);
        bright = rf_larger(bright, light);
        if (bright >> doublings > dark)
            break;
    }
    return count;
}

/* Counts the runs of a tile or, if `lists`, lists them. */
static uint32_t take_runs(const struct listing *listing, const struct patch *patch,
                          struct rf_rect tile, int doublings, bool lists)
{
    const int width = tile.x1 - tile.x0;
    uint32_t runs = 0;

    for (int y = 0; y < tile.y1 - tile.y0; y++)
        for (int x = 0, count; x < width; x += rf_larger(count, 1)) {
            struct rf_highlight run;

            count = run_length(patch, y * RF_TILE + x, width - x, doublings);
            if (!count)
                continue;
            runs++;
            if (!lists)
                continue;
            run = run_of(patch, tile, x, y, count);
            rf_list_highlight(listing->highlights, &run);
        }
    return runs;
}

/* Reads a tile. Returns how many of its pixels are above white. */
static int read_tile(const struct rf_deep *photo, struct patch *patch, struct rf_rect tile)
{
    int count = 0;

    for (int y = tile.y0; y < tile.y1; y++)
        count += read_row(photo, patch, (y - tile.y0) * RF_TILE, tile.x0, tile.x1, y);
    return count;
}

/* Whether a tile is at a side of the photo, beyond which rays find it repeated, and discs do not.
 */
static bool is_at_side(const struct rf_deep *photo, struct rf_rect tile)
{
    return !tile.x0 || !tile.y0 || tile.x1 == photo->image.width || tile.y1 == photo->image.height;
}

/* How often a part's light may double within a run: the fewer, the more runs there are. */
enum { MOST_DOUBLINGS = 10 };

struct choice {
    int doublings; /* 1 to MOST_DOUBLINGS */
    bool large_by_rays, all_by_rays;
};

/* Runs of a part of the photo, of tiles that are above white in part, and as a whole. */
struct counts {
    uint32_t some, whole;
};

/* Counts the runs of a part or, if `lists`, lists them, but of tiles that are left to the rays. */
static struct counts go_through(const struct listing *listing, int part, struct choice choice,
                                bool lists)
{
    const struct rf_deep *photo = listing->photo;
    const int rows = (photo->image.height + RF_TILE - 1) / RF_TILE;
    const int ty0 = part * (RF_HIGHLIGHT_ROWS / RF_TILE);
    const int ty1 = rf_smaller(ty0 + RF_HIGHLIGHT_ROWS / RF_TILE, rows);
    struct counts runs = {0, 0};
    struct patch patch;

    for (int ty = ty0; ty < ty1; ty++)
        for (int tx = 0; tx < listing->tiles_x && !rf_cancelled(listing->exec); tx++) {
            const struct rf_rect tile = tile_of(photo, tx, ty);
            uint8_t *by_rays = &listing->highlights->by_rays[ty * listing->tiles_x + tx];
            const int count = read_tile(photo, &patch, tile);
            const bool whole = count == (tile.x1 - tile.x0) * (tile.y1 - tile.y0);

            *by_rays = count && (choice.all_by_rays ||
                                 (whole && (choice.large_by_rays || is_at_side(photo, tile))));
            if (count && !*by_rays)
                *(whole ? &runs.whole : &runs.some) +=
                    take_runs(listing, &patch, tile, choice.doublings, lists);
        }
    return runs;
}

/* Lists the runs of a part: the first choice that the list has room for. */
static void list_part(void *context, int item, int worker)
{
    const struct listing *listing = context;
    const uint32_t capacity = listing->highlights->part[item].capacity;
    struct choice choice = {1, false, false};
    struct counts runs = go_through(listing, item, choice, false);

    (void)worker;
    while (runs.some + runs.whole > capacity && choice.doublings < MOST_DOUBLINGS) {
        choice.doublings++;
        runs = go_through(listing, item, choice, false);
    }
    choice.large_by_rays = runs.some + runs.whole > capacity;
    choice.all_by_rays = runs.some > capacity;
    go_through(listing, item, choice, true);
}

void rf_list_known(const struct rf_executor *exec, const struct rf_deep *photo,
                   struct rf_highlights *highlights)
{
    struct listing listing = {exec, photo, highlights,
                              (photo->image.width + RF_TILE - 1) / RF_TILE};

    rf_clear_highlights(highlights);
    rf_pool_run(exec->pool, list_part, &listing,
                (photo->image.height + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS);
    if (!rf_cancelled(exec))
        rf_sort_highlights(exec, highlights);
}

void rf_known_light(const struct rf_deep *photo, const struct rf_highlight *run, int from, int to,
                    double light[3])
{
    light[0] = light[1] = light[2] = 0;
    for (int i = from; i < to; i++) {
        int excess[3];

        rf_known_excess(photo, run->x + i, run->y, excess);
        for (int c = 0; c < 3; c++)
            light[c] += excess[c];
    }
}

bool rf_leaves_known(const struct rf_highlight_window *window)
{
    const struct rf_viewport *view = window->view;
    const int tiles_x = (view->photo_width + RF_TILE - 1) / RF_TILE;
    const int tiles_y = (view->photo_height + RF_TILE - 1) / RF_TILE;

    return window->known &&
           memchr(window->highlights->by_rays, true, (size_t)tiles_x * (size_t)tiles_y);
}

struct boost {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    struct rf_light_q12 smooth;
    struct rf_background background;
    double gap;
    int most;
};

bool rf_known_is_left(const struct rf_highlight_window *w, int tx, int ty)
{
    const struct rf_viewport *view = w->view;
    const int tiles_x = (view->photo_width + RF_TILE - 1) / RF_TILE;
    const int tiles_y = (view->photo_height + RF_TILE - 1) / RF_TILE;
    const int x = view->x0 / RF_TILE + tx, y = view->y0 / RF_TILE + ty;

    return x >= 0 && y >= 0 && x < tiles_x && y < tiles_y &&
           w->highlights->by_rays[y * tiles_x + x];
}

static bool is_near_left(const struct rf_highlight_window *w, int tx, int ty)
{
    for (int i = 0; i < 9; i++)
        if (rf_known_is_left(w, tx + i % 3 - 1, ty + i / 3 - 1))
            return true;
    return false;
}

/* Reads what is left to the rays in and around a tile of the window; 0 elsewhere. */
static void read_left(const struct rf_highlight_window *w, int tx, int ty, struct patch *patch)
{
    const struct rf_viewport *view = w->view;
    const int x0 = tx * RF_TILE - REACH, y0 = ty * RF_TILE - REACH;

    memset(patch, 0, sizeof *patch);
    for (int i = 0; i < 9; i++) {
        const int nx = tx + i % 3 - 1, ny = ty + i / 3 - 1;
        /* The part of that tile that lies in the patch and in the window. */
        const struct rf_rect part = {
            rf_larger(rf_larger(nx * RF_TILE, x0), 0), rf_larger(rf_larger(ny * RF_TILE, y0), 0),
            rf_smaller(rf_smaller((nx + 1) * RF_TILE, x0 + PATCH), view->width),
            rf_smaller(rf_smaller((ny + 1) * RF_TILE, y0 + PATCH), view->height)};

        for (int y = part.y0; y < part.y1 && part.x0 < part.x1 && rf_known_is_left(w, nx, ny); y++)
            read_row(w->known, patch, (y - y0) * PATCH + part.x0 - x0, view->x0 + part.x0,
                     view->x0 + part.x1, view->y0 + y);
    }
}

/* The mean of the patch over the pixels around one that are blurred as it is. */
static void mean_around(const struct boost *b, const struct patch *patch, int x, int y, int at,
                        int reach, int mean[3])
{
    const struct rf_viewport *view = b->window->view;
    const int own = rf_window_blur(b->window, x, y);
    int64_t sum[3] = {0, 0, 0};
    int count = 0;

    for (int v = rf_larger(-reach, -y); v <= rf_smaller(reach, view->height - 1 - y); v++)
        for (int u = rf_larger(-reach, -x); u <= rf_smaller(reach, view->width - 1 - x); u++) {
            if (u * u + v * v > reach * reach + 1 ||
                abs(rf_window_blur(b->window, x + u, y + v) - own) > ALIKE)
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += patch->excess[c][at + v * PATCH + u];
            count++;
        }
    for (int c = 0; c < 3; c++)
        mean[c] = (int)((sum[c] + count / 2) / count);
}

/* Adds light to a pixel. Returns the brightest of its channels. */
static int add_light(const struct boost *b, int x, int y, const int more[3])
{
    int brightest = 0;

    for (int c = 0; c < 3; c++) {
        uint16_t *light = &b->smooth.channel[c][y * b->smooth.stride + x];
        const int64_t sum = *light + (int64_t)more[c];

        *light = (uint16_t)(sum < b->most ? sum : b->most);
        brightest = rf_larger(brightest, *light);
    }
    return brightest;
}

/* Rays may find a pixel that nothing hides in the hidden background. */
static void copy_behind(const struct boost *b, int x, int y)
{
    const struct rf_background *const to = &b->background;

    if (to->blur.at[y * to->blur.stride + x] != b->window->blur.at[y * b->window->blur.stride + x])
        return;
    for (int c = 0; c < 3; c++)
        to->light.channel[c][y * to->light.stride + x] =
            b->smooth.channel[c][y * b->smooth.stride + x];
}

/* Adds their own light to pixels in focus. It shows where something before them is blurred: there
 * it is what some of the rays hit. */
static int boost_in_focus(const struct boost *b, int tx, int ty)
{
    const struct rf_highlight_window *w = b->window;
    const struct rf_viewport *view = w->view;
    const int x1 = rf_smaller((tx + 1) * RF_TILE, view->width);
    const int y1 = rf_smaller((ty + 1) * RF_TILE, view->height);
    int brightest = 0;

    for (int y = ty * RF_TILE; y < y1; y++)
        for (int x = tx * RF_TILE; x < x1; x++) {
            int own[3];

            if (abs(rf_window_blur(w, x, y)) >= RF_KNOWN_FROM)
                continue;
            rf_known_excess(w->known, view->x0 + x, view->y0 + y, own);
            brightest = rf_larger(brightest, add_light(b, x, y, own));
            copy_behind(b, x, y);
        }
    return brightest;
}

/* Light that is left to the rays and out of focus becomes the mean around. */
static int boost_left(const struct boost *b, int tx, int ty)
{
    const struct rf_highlight_window *w = b->window;
    const struct rf_viewport *view = w->view;
    const int x1 = rf_smaller((tx + 1) * RF_TILE, view->width);
    const int y1 = rf_smaller((ty + 1) * RF_TILE, view->height);
    struct patch patch;
    int brightest = 0;

    read_left(w, tx, ty, &patch);
    for (int y = ty * RF_TILE; y < y1; y++)
        for (int x = tx * RF_TILE; x < x1; x++) {
            const int at = (y % RF_TILE + REACH) * PATCH + x % RF_TILE + REACH;
            const int blur = abs(rf_window_blur(w, x, y));
            const int half = (int)(b->gap * blur / 512);
            int mean[3];

            if (blur < RF_KNOWN_FROM)
                continue;
            mean_around(b, &patch, x, y, at, half < REACH ? half : REACH, mean);
            brightest = rf_larger(brightest, add_light(b, x, y, mean));
        }
    return brightest;
}

static void boost_tile(void *context, int item, int worker)
{
    const struct boost *b = context;
    const struct rf_highlight_window *w = b->window;
    const int tx = item % w->view->tiles_x, ty = item / w->view->tiles_x;
    uint16_t *const brightest = &w->bins[item].brightest;

    (void)worker;
    *brightest = (uint16_t)rf_larger(*brightest, boost_in_focus(b, tx, ty));
    if (is_near_left(w, tx, ty))
        *brightest = (uint16_t)rf_larger(*brightest, boost_left(b, tx, ty));
}

/* Rays read beyond the window's sides, too. */
static void extend_band(void *context, int band, int worker)
{
    const struct boost *b = context;
    const struct rf_viewport *view = b->window->view;

    (void)worker;
    for (int c = 0; c < 3; c++) {
        rf_extend_rows(view, b->smooth.channel[c], b->smooth.stride, rf_band_start(band),
                       rf_band_end(view, band));
        rf_extend_rows(view, b->background.light.channel[c], b->background.light.stride,
                       rf_band_start(band), rf_band_end(view, band));
    }
}

void rf_boost_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    struct rf_light_q12 smooth, struct rf_background background, double gap,
                    int most)
{
    struct boost boost = {exec, window, smooth, background, gap, most};

    rf_pool_run(exec->pool, boost_tile, &boost, window->view->tiles_x * window->view->tiles_y);
    rf_pool_run(exec->pool, extend_band, &boost, rf_bands(window->view));
}

void rf_raise_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    const struct rf_foreground_cells *foreground)
{
    const struct rf_viewport *view = window->view;

    for (int ty = 0; ty < view->tiles_y && !rf_cancelled(exec); ty++)
        for (int tx = 0; tx < view->tiles_x; tx++)
            if (rf_known_is_left(window, tx, ty))
                rf_force_foreground(view, foreground,
                                    (struct rf_rect){tx * RF_TILE - REACH, ty * RF_TILE - REACH,
                                                     (tx + 1) * RF_TILE + REACH,
                                                     (ty + 1) * RF_TILE + REACH});
}
