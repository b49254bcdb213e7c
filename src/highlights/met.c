/* met.c: lamps that rays meet, where they are not drawn. */
#include "highlights/highlights.h"

#include <stdbool.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "highlights/runs.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    WIDEST = 3,    /* pixels that a lamp is widened by */
    BLURRED = 512, /* Q7.8: what it may be widened over, */
    ALIKE = 256,   /* if it is farther away than that: else the pre-filter takes it for the same */
    DOTS = 2,      /* gaps of the rays that a lamp has to be wide for not to show as dots */
};

/* How rays meet them. */
struct met {
    struct refocus_renderer *r;
    struct rf_bin_scale scale;
    double gap; /* of the rays, times the blur */
    int share;  /* of what lamps lost, Q8 */
    int most;   /* light that there may be */
};

/* Calls `then` for each lamp of a part; ends early when the run is cancelled. */
static void for_each(const struct met *met, int part,
                     void (*then)(const struct met *met, const struct rf_highlight *lamp))
{
    const struct rf_highlights *found = &met->r->photo.highlights[part];

    for (uint32_t i = 0; i < found->count; i++) {
        if (rf_cancelled_at(&met->r->exec, i))
            return;
        then(met, &found->lamp[i]);
    }
}

static bool is_left_alone(const struct rf_highlight *lamp, int i)
{
    return lamp->edges >> i & 1;
}

/* Half a gap of the rays at a blur, in pixels. */
static int reach_of(int blur, double gap)
{
    const int half = (int)(gap * abs(blur) / 512);

    return half < WIDEST ? half : WIDEST;
}

/*
 * Rays whose gaps are wider than a lamp would show it as a disc of dots. What is around
 * it within half a gap, farther away and blurred itself, takes its blur: then the
 * pre-filter spreads its light over that.
 */
static void widen(struct refocus_renderer *r, int lamp_x, int lamp_y, struct rf_bin_scale scale,
                  double gap)
{
    const int16_t own = r->blur.at[lamp_y * r->view.stride + lamp_x];
    const int reach = reach_of(own, gap);

    for (int y = lamp_y - reach; y <= lamp_y + reach; y++) {
        for (int x = lamp_x - reach; x <= lamp_x + reach; x++) {
            const int dx = x - lamp_x, dy = y - lamp_y;
            int16_t *s;

            if (x < 0 || y < 0 || x >= r->view.width || y >= r->view.height ||
                dx * dx + dy * dy > reach * reach + 1)
                continue;
            s = r->blur.at + y * r->view.stride + x;
            if (*s > own + ALIKE && abs(*s) > BLURRED) {
                *s = own;
                rf_add_bin(&r->view, r->bins, scale, x, y, own);
                rf_add_to_cell(&r->cells, x, y, own);
            }
        }
    }
}

/* Of lamps that rays lie so far apart at that few meet them, and show them as dots. */
static void note_dots(const struct met *met, const struct rf_highlight *lamp)
{
    struct refocus_renderer *r = met->r;
    const double dots = lamp->size * 256 / (DOTS * met->gap); /* from this blur on */

    for (int i = 0, x, y; i < lamp->count; i++) {
        struct rf_bins *bins;
        int blur;

        if (!rf_place_of(r, lamp, i, &x, &y) || is_left_alone(lamp, i))
            continue;
        bins = &r->bins[(size_t)(y / RF_TILE) * r->view.tiles_x + x / RF_TILE];
        blur = abs(r->blur.at[y * r->view.stride + x]);
        if (blur > dots && blur > bins->dots)
            bins->dots = (int16_t)blur;
    }
}

static void widen_all(const struct met *met, const struct rf_highlight *lamp)
{
    struct refocus_renderer *r = met->r;
    const struct rf_blurs near = rf_blurs_in(r, rf_around_run(r, lamp, WIDEST));

    if (near.most - near.least <= ALIKE)
        return;
    for (int i = 0, x, y; i < lamp->count; i++)
        if (rf_place_of(r, lamp, i, &x, &y) && !is_left_alone(lamp, i) &&
            near.most > r->blur.at[y * r->view.stride + x] + ALIKE)
            widen(r, x, y, met->scale, met->gap);
}

void rf_widen_highlights(struct refocus_renderer *r, struct rf_bin_scale scale, double gap)
{
    const struct met met = {.r = r, .scale = scale, .gap = gap};

    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++) {
        for_each(&met, part, note_dots);
        for_each(&met, part, widen_all);
    }
}

static void put_in_front(const struct met *met, const struct rf_highlight *lamp)
{
    struct refocus_renderer *r = met->r;

    for (int i = 0, x, y; i < lamp->count; i++) {
        int reach;

        if (!rf_place_of(r, lamp, i, &x, &y) || is_left_alone(lamp, i))
            continue;
        reach = 1 + reach_of(r->blur.at[y * r->view.stride + x], met->gap);
        rf_put_in_front(&r->view, &r->foreground,
                        (struct rf_rect){x - reach, y - reach, x + reach, y + reach});
    }
}

void rf_put_lamps_in_front(struct refocus_renderer *r, double gap)
{
    const struct met met = {.r = r, .gap = gap};

    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++)
        for_each(&met, part, put_in_front);
}

/* What pixel i of a lamp, at `at`, gets of a share of what it lost, Q8 of what is `added`. */
static void gain_of(const struct refocus_renderer *r, const struct rf_highlight *lamp, int i,
                    ptrdiff_t at, int share, int gained[3])
{
    /* from half a pixel of blur on, all of it from one pixel and a half on */
    const int blurred = is_left_alone(lamp, i) ? 0 : rf_ramp(abs(r->blur.at[at]), 128, 384);

    for (int c = 0; c < 3; c++)
        gained[c] = (((lamp->added[c] * share) >> 8) * blurred) >> 8;
}

/* Places within `reach` of (cx, cy) that have its blur, at most (2 WIDEST + 1)^2; it
 * itself at least. */
static int places_of(const struct refocus_renderer *r, int cx, int cy, int reach,
                     ptrdiff_t place[(2 * WIDEST + 1) * (2 * WIDEST + 1)])
{
    const int own = r->blur.at[cy * r->view.stride + cx];
    int count = 0;

    for (int y = cy - reach; y <= cy + reach; y++) {
        for (int x = cx - reach; x <= cx + reach; x++) {
            const int dx = x - cx, dy = y - cy;
            const ptrdiff_t at = y * r->view.stride + x;

            if (x >= 0 && y >= 0 && x < r->view.width && y < r->view.height &&
                dx * dx + dy * dy <= reach * reach + 1 && abs(r->blur.at[at] - own) <= 256)
                place[count++] = at;
        }
    }
    return count;
}

/* How far the light of a lamp's pixel is spread: of lamps that are narrower than one and a half
 * gaps, which few rays meet, a pixel more. */
static int spread_of(const struct rf_highlight *lamp, int blur, double gap)
{
    const int reach = reach_of(blur, gap);

    return 512 * lamp->size < 3 * gap * abs(blur) && reach < WIDEST ? reach + 1 : reach;
}

/* Sums of tiles that pixels within `reach` of (x, y) are met from have to hold their light. */
static void note_light(struct refocus_renderer *r, int x, int y, int reach, int light)
{
    const int tx0 = rf_within(x - reach, r->view.width - 1) / RF_TILE;
    const int tx1 = rf_within(x + reach, r->view.width - 1) / RF_TILE;
    const int ty0 = rf_within(y - reach, r->view.height - 1) / RF_TILE;
    const int ty1 = rf_within(y + reach, r->view.height - 1) / RF_TILE;

    for (int ty = ty0; ty <= ty1; ty++)
        for (int tx = tx0; tx <= tx1; tx++) {
            struct rf_bins *bins = &r->bins[(size_t)ty * r->view.tiles_x + tx];

            bins->brightest = (uint16_t)(light > bins->brightest ? light : bins->brightest);
        }
}

/* Pixel i of a lamp. */
static void add_spread(const struct met *met, const struct rf_highlight *lamp, int i)
{
    struct refocus_renderer *r = met->r;
    const int planes = r->yuv.on ? 1 : 3; /* of Y, U and V all three are one */
    ptrdiff_t place[(2 * WIDEST + 1) * (2 * WIDEST + 1)], at;
    int x, y, reach, places, gained[3], brightest = 0;

    if (!rf_place_of(r, lamp, i, &x, &y))
        return;
    at = y * r->view.stride + x;
    reach = spread_of(lamp, r->blur.at[at], met->gap);
    places = places_of(r, x, y, reach, place);
    gain_of(r, lamp, i, at, met->share, gained);
    for (int k = 0; k < places; k++) {
        for (int c = 0; c < planes; c++) {
            const int sum = r->smooth.channel[c][place[k]] + (gained[c] + places / 2) / places;
            const int light = sum < met->most ? sum : met->most;

            r->smooth.channel[c][place[k]] = (uint16_t)light;
            brightest = light > brightest ? light : brightest;
        }
    }
    note_light(r, x, y, reach, brightest);
}

static void add_run(const struct met *met, const struct rf_highlight *lamp)
{
    for (int i = 0; i < lamp->count; i++)
        add_spread(met, lamp, i);
}

void rf_add_highlights(struct refocus_renderer *r, float gain, double gap, int most)
{
    const struct met met = {
        .r = r,
        .gap = gap,
        .share = (int)((gain - 1) * (256 / 3) + 0.5f), /* of what is three times white */
        .most = most,
    };

    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++)
        for_each(&met, part, add_run);
}
