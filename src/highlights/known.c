/* known.c: the light above white of photos that hold it is listed as highlights where there is room
 * for it, and elsewhere, where much of the photo is brighter than white, left to the rays. */
#include "highlights/known.h"

#include <limits.h>
#include <string.h>

#include "support/compare.h"

enum { LEAST = RF_LIGHT_MAX / 32 }; /* light above white that counts, Q12 */

/* Light above white of the pixels of a tile, Q12. */
struct patch {
    int excess[3][RF_TILE * RF_TILE];
    bool any[RF_TILE * RF_TILE]; /* the pixel has some that counts, in any channel */
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
    const float light = (exact - 1) * RF_LIGHT_MAX, most = (float)UINT16_MAX * RF_KNOWN_UNIT;

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
        run.boost[c] = (uint16_t)((sum + count * RF_KNOWN_UNIT / 2) / (count * RF_KNOWN_UNIT));
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
            const int pixels = (tile.x1 - tile.x0) * (tile.y1 - tile.y0);
            const bool whole = count == pixels;

            *by_rays = count && (choice.all_by_rays || (whole && choice.large_by_rays) ||
                                 (2 * count >= pixels && is_at_side(photo, tile)));
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

    rf_clear_highlights(highlights, photo->image.width, photo->image.height, true);
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
