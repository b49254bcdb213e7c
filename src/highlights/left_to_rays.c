/* left_to_rays.c: prepares highlights that are not splatted but left to the rays: tells where few
 * rays hit one, and gives back the light that clipping took. */
#include "highlights/highlights.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>

#include "highlights/ramp.h"
#include "highlights/in_window.h"
#include "highlights/known.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    WIDEST = 3,       /* pixels that the light of a highlight is spread over, each way */
    ALIKE = 256,      /* Q7.8: how much blurs may differ that it is spread over */
    WELL_SAMPLED = 2, /* gaps of the rays that a highlight has to be wide for its disc to be even */
    PLACES = (2 * WIDEST + 1) * (2 * WIDEST + 1), /* pixels that light spreads over */
};

/* The inputs of the three steps, of which each uses some. */
struct gather {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    double gap;                                   /* gap of the rays, times the blur */
    const struct rf_foreground_cells *foreground; /* raise */
    struct rf_light_q12 light;                    /* boost: light that rays hit */
    int share; /* boost: part of what clipping cost that is given back, Q8 */
    int most;  /* boost: greatest light that a pixel may get */
};

/* Calls `then` for each run of a part; ends early when the run is cancelled. */
static void for_each(const struct gather *g, int part,
                     void (*then)(const struct gather *g, const struct rf_highlight *run))
{
    const struct rf_highlight_list *list = &g->window->highlights->part[part];

    for (uint32_t i = 0; i < list->count; i++) {
        if (rf_cancelled_at(g->exec, i))
            return;
        then(g, &list->run[i]);
    }
}

/* Half a gap of the rays at a blur, in pixels. */
static int reach_of(int blur, double gap)
{
    const int half = (int)(gap * abs(blur) / 512);

    return half < WIDEST ? half : WIDEST;
}

/* Notes in the bins of tiles the highlights that rays sample too sparsely at their blur. */
static void note_undersampled(const struct gather *g, const struct rf_highlight *run)
{
    const struct rf_highlight_window *w = g->window;
    const double from = run->size * 256 / (WELL_SAMPLED * g->gap); /* from this blur on */

    for (int i = 0, x, y; i < run->count; i++) {
        struct rf_bins *bins;
        int blur;

        if (!rf_place_in(w->view, run, i, &x, &y))
            continue;
        bins = &w->bins[(size_t)(y / RF_TILE) * w->view->tiles_x + x / RF_TILE];
        blur = abs(rf_window_blur(g->window, x, y));
        if (blur > from && rf_in_units(blur, w->blur.unit) > bins->undersampled)
            bins->undersampled = rf_in_units(blur, w->blur.unit);
    }
}

void rf_note_undersampled(const struct rf_executor *exec, const struct rf_highlight_window *window,
                          double gap)
{
    const struct gather g = {.exec = exec, .window = window, .gap = gap};
    const struct rf_highlight_parts parts = rf_parts_in(window->view);

    for (int i = 0; i < parts.count; i++)
        for_each(&g, parts.first + i, note_undersampled);
}

static void raise_run(const struct gather *g, const struct rf_highlight *run)
{
    for (int i = 0, x, y; i < run->count; i++) {
        int reach;

        if (!rf_place_in(g->window->view, run, i, &x, &y))
            continue;
        reach = 1 + reach_of(rf_window_blur(g->window, x, y), g->gap);
        rf_force_foreground(g->window->view, g->foreground,
                            (struct rf_rect){x - reach, y - reach, x + reach, y + reach});
    }
}

void rf_raise_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                         const struct rf_foreground_cells *foreground, double gap)
{
    const struct gather g = {.exec = exec, .window = window, .gap = gap, .foreground = foreground};
    const struct rf_highlight_parts parts = rf_parts_in(window->view);

    for (int i = 0; i < parts.count; i++)
        for_each(&g, parts.first + i, raise_run);
}

/* The light that a pixel of a run, so blurred, gets: a share of what clipping cost, Q8 of `boost`.
 * Of a photo of Y, U and V it is luminance, and the only one. */
static void gain_of(const struct gather *g, const struct rf_highlight *run, int blur, int gained[3])
{
    /* from half a pixel of blur on, all of it from one pixel and a half on */
    const int blurred = rf_ramp(abs(blur), 128, 384);

    static_assert((int64_t)3 * RF_LIGHT_MAX * ((RF_MOST_GAIN - 1) * 85 + 1) <= INT32_MAX &&
                      (int64_t)UINT16_MAX * ((RF_KNOWN_GAIN - 1) * 85 + 1) <= INT32_MAX,
                  "the light of the largest gain in Q8, and that times a ramp in Q8 over 2^8");
    for (int c = 0; c < 3; c++)
        gained[c] = (((run->boost[c] * g->share) >> 8) * blurred) >> 8;
    if (g->window->yuv) {
        const struct rf_yuv_curve *curve = &g->window->yuv->curve;

        static_assert((3 * RF_LIGHT_MAX * ((RF_MOST_GAIN - 1) * 85 + 1) >> 8) * (int64_t)RF_SHARE <=
                          INT32_MAX,
                      "the light of the largest gain times shares that add up to 1");
        gained[0] =
            (curve->kr * gained[0] + curve->kg * gained[1] + curve->kb * gained[2]) / RF_SHARE;
    }
}

/* Lists places within `reach` of (cx, cy) that have its blur; it itself at least. */
static int places_of(const struct gather *g, int cx, int cy, int reach, ptrdiff_t place[PLACES])
{
    const struct rf_viewport *view = g->window->view;
    const int own = rf_window_blur(g->window, cx, cy);
    int count = 0;

    for (int y = cy - reach; y <= cy + reach; y++) {
        for (int x = cx - reach; x <= cx + reach; x++) {
            const int dx = x - cx, dy = y - cy;

            if (x >= 0 && y >= 0 && x < view->width && y < view->height &&
                dx * dx + dy * dy <= reach * reach + 1 &&
                abs(rf_window_blur(g->window, x, y) - own) <= ALIKE)
                place[count++] = y * g->light.stride + x;
        }
    }
    return count;
}

/* How far the light of a pixel is spread: of highlights that are narrower than one and a half gaps,
 * which few rays hit, a pixel more. */
static int spread_of(const struct rf_highlight *run, int blur, double gap)
{
    const int reach = reach_of(blur, gap);

    return 512 * run->size < 3 * gap * abs(blur) && reach < WIDEST ? reach + 1 : reach;
}

/* Notes light in the tiles that rays hit pixels within `reach` of (x, y) from: their sums have to
 * hold it. */
static void note_light(const struct rf_highlight_window *w, int x, int y, int reach, int light)
{
    const int tx0 = rf_within(x - reach, w->view->width - 1) / RF_TILE;
    const int tx1 = rf_within(x + reach, w->view->width - 1) / RF_TILE;
    const int ty0 = rf_within(y - reach, w->view->height - 1) / RF_TILE;
    const int ty1 = rf_within(y + reach, w->view->height - 1) / RF_TILE;

    for (int ty = ty0; ty <= ty1; ty++)
        for (int tx = tx0; tx <= tx1; tx++) {
            struct rf_bins *bins = &w->bins[(size_t)ty * w->view->tiles_x + tx];

            bins->brightest = (uint16_t)(light > bins->brightest ? light : bins->brightest);
        }
}

/* Boosts pixel i of a run. */
static void boost_pixel(const struct gather *g, const struct rf_highlight *run, int i)
{
    ptrdiff_t place[PLACES];
    int x, y, reach, places, gained[3], brightest = 0;

    if (!rf_place_in(g->window->view, run, i, &x, &y))
        return;
    reach = spread_of(run, rf_window_blur(g->window, x, y), g->gap);
    places = places_of(g, x, y, reach, place);
    gain_of(g, run, rf_window_blur(g->window, x, y), gained);
    for (int k = 0; k < places; k++) {
        for (int c = 0; c < rf_channels_of_light(g->window); c++) {
            uint16_t *const at = g->light.channel[c] + place[k];
            const int sum = *at + (gained[c] + places / 2) / places;
            const int light = sum < g->most ? sum : g->most;

            *at = (uint16_t)light;
            brightest = light > brightest ? light : brightest;
        }
    }
    note_light(g->window, x, y, reach, brightest);
}

static void boost_run(const struct gather *g, const struct rf_highlight *run)
{
    for (int i = 0; i < run->count; i++)
        boost_pixel(g, run, i);
}

enum rf_bright rf_bright_of(float gain)
{
    return gain <= 1                   ? RF_WHITE
           : gain <= RF_PLAIN_GAIN     ? RF_BRIGHT
           : gain <= 2 * RF_PLAIN_GAIN ? RF_BRIGHTER
                                       : RF_BRIGHTEST;
}

int rf_most_light(enum rf_bright bright)
{
    static const int times[] = {
        [RF_WHITE] = 1, [RF_BRIGHT] = 4, [RF_BRIGHTER] = 8, [RF_BRIGHTEST] = 16};

    return times[bright] * RF_LIGHT_MAX;
}

void rf_boost_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                         struct rf_light_q12 smooth, float gain, double gap, int most)
{
    const struct gather g = {
        .exec = exec,
        .window = window,
        .gap = gap,
        .light = smooth,
        .share = (int)((gain - 1) * (256 / 3) + 0.5f), /* part of the light of three times white */
        .most = most,
    };
    const struct rf_highlight_parts parts = rf_parts_in(window->view);

    for (int i = 0; i < parts.count; i++)
        for_each(&g, parts.first + i, boost_run);
}
