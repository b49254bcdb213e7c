#include "highlights/highlights.h"

#include <stdbool.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "renderer/bands.h"
#include "support/compare.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    WIDEST = 3,      /* pixels that a lamp is widened by */
    BLURRED = 512,   /* Q7.8: what it may be widened over, */
    ALIKE = 256,     /* if it is farther away than that: else the pre-filter takes it for the same */
    EDGE_FROM = 128, /* Q7.8: what something bright is sharper by for this to be its edge, */
    EDGE_PART = 16,  /* by that part of this blur at least, and wholly so by 3 times that; where
                        lamps are not drawn, by twice that */
    DISC_RIM = 256,  /* Q7.8: what a disc goes beyond the blur of a lamp's pixel, half a pixel at its
                        rim and half of what blurs of a run may differ by, and some */
    STACKED = 4096,  /* Q7.8: from this blur on two rows of a lamp are drawn as one, from twice that on
                        four, */
    STACK_RIM = 512, /* which may reach farther by what rows differ by at their ends */
    DOTS = 2,        /* gaps of the rays that a lamp has to be wide for not to show as dots */
};

/* How much sharper than it the sharpest bright pixel beside (x, y) is, Q7.8. If by a pixel of blur,
 * this one is the edge of that, and only its depth says otherwise. */
static int edge_of(const struct refocus_renderer *r, int x, int y)
{
    const int own = abs(r->front.blur[y * r->stride + x]);
    int sharpest = own;

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const ptrdiff_t at =
                rf_within(y + j, r->height - 1) * r->stride + rf_within(x + i, r->width - 1);
            const int blur = abs(r->front.blur[at]);

            if (blur < sharpest && rf_brightest_at(r, at) >= RF_CLIPPED)
                sharpest = blur;
        }
    }
    return own - sharpest;
}

/* Where in the window pixel i of a highlight is; false: not in it. */
static bool place_of(const struct refocus_renderer *r, const struct rf_highlight *lamp, int i,
                     int *x, int *y)
{
    *x = lamp->x + i - r->origin_x;
    *y = lamp->y - r->origin_y;
    return *x >= 0 && *y >= 0 && *x < r->width && *y < r->height;
}

static bool is_left_alone(const struct rf_highlight *lamp, int i)
{
    return lamp->edges >> i & 1;
}

int rf_first_lamp_part(const struct refocus_renderer *r)
{
    return r->origin_y / RF_LAMP_ROWS;
}

int rf_last_lamp_part(const struct refocus_renderer *r)
{
    return (r->origin_y + r->height - 1) / RF_LAMP_ROWS;
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
static void widen(struct refocus_renderer *r, int lamp_x, int lamp_y,
                  struct rf_bin_scale scale, double gap)
{
    const int16_t own = r->front.blur[lamp_y * r->stride + lamp_x];
    const int reach = reach_of(own, gap);

    for (int y = lamp_y - reach; y <= lamp_y + reach; y++) {
        for (int x = lamp_x - reach; x <= lamp_x + reach; x++) {
            const int dx = x - lamp_x, dy = y - lamp_y;
            int16_t *s;

            if (x < 0 || y < 0 || x >= r->width || y >= r->height ||
                dx * dx + dy * dy > reach * reach + 1)
                continue;
            s = r->front.blur + y * r->stride + x;
            if (*s > own + ALIKE && abs(*s) > BLURRED) {
                *s = own;
                rf_add_bin(r, scale, x / RF_TILE, y / RF_TILE, own);
                rf_add_to_cell(r, x, y, own);
            }
        }
    }
}

/* The pixels of a lamp that are in the window, and so many around them there; empty: none are. */
static struct rf_rect around_lamp(const struct refocus_renderer *r, const struct rf_highlight *lamp,
                                  int by)
{
    const int x0 = lamp->x - r->origin_x, x1 = x0 + lamp->count, y = lamp->y - r->origin_y;

    if (y < 0 || y >= r->height || x1 <= 0 || x0 >= r->width)
        return (struct rf_rect){0, 0, 0, 0};
    return (struct rf_rect){rf_within(x0 - by, r->width), rf_within(y - by, r->height),
                            rf_within(x1 + by, r->width), rf_within(y + by + 1, r->height)};
}

/* The greatest and the least blur there. */
static struct blurs {
    int least, most;
    int sharpest; /* least |s| */
} blurs_in(const struct refocus_renderer *r, struct rf_rect rect)
{
    struct blurs in = {INT16_MAX, INT16_MIN, INT16_MAX};

    for (int y = rect.y0; y < rect.y1; y++) {
        const int16_t *s = r->front.blur + y * r->stride;

        for (int x = rect.x0; x < rect.x1; x++) {
            in.least = s[x] < in.least ? s[x] : in.least;
            in.most = s[x] > in.most ? s[x] : in.most;
            in.sharpest = abs(s[x]) < in.sharpest ? abs(s[x]) : in.sharpest;
        }
    }
    return in;
}

int rf_lamp_shine(const struct refocus_renderer *r, int x, int y)
{
    const int size = abs(r->front.blur[y * r->stride + x]);
    const int from = rf_larger(EDGE_FROM, size / EDGE_PART);

    return 256 - rf_ramp(edge_of(r, x, y), from, 3 * from);
}

/* How far the disc of a pixel so blurred may reach where it is drawn with others. */
static int disc_reach(int size)
{
    return rf_smaller(size + DISC_RIM + (size < STACKED ? 0 : STACK_RIM), INT16_MAX);
}

static void note_reach(struct refocus_renderer *r, int x, int y, int reach)
{
    struct rf_bins *bins = &r->bins[(size_t)(y / RF_TILE) * r->tiles_x + x / RF_TILE];

    bins->lamp = (int16_t)rf_larger(reach, bins->lamp);
}

/* The mean blur of what of a run is blurred as its middle is, if that is two thirds of what
 * shines: the rest, its rim with the depth of what is beside it, belongs to it as well. */
static int blur_of_most(struct refocus_renderer *r, const struct rf_highlight *lamp)
{
    int x, y, middle, sum = 0, weight = 0, reach;

    if (!place_of(r, lamp, lamp->count / 2, &x, &y))
        return RF_NO_BLUR;
    middle = r->front.blur[y * r->stride + x];
    for (int i = 0; i < lamp->count; i++) {
        const int shines =
            !place_of(r, lamp, i, &x, &y) ? 0 : lamp->edges >> i & 1 ? rf_lamp_shine(r, x, y) : 256;
        const int blur = shines ? r->front.blur[y * r->stride + x] : 0;

        if (shines && 2 * abs(blur - middle) <= rf_blurs_alike(middle)) {
            sum += shines * blur;
            weight += shines;
        }
    }
    if (3 * weight < 2 * lamp->shining || !weight)
        return RF_NO_BLUR;
    reach = disc_reach(abs(sum / weight));
    for (int i = 0; i < lamp->count; i++)
        if (place_of(r, lamp, i, &x, &y))
            note_reach(r, x, y, reach);
    return sum / weight;
}

static void mark(struct refocus_renderer *r, struct rf_highlight *lamp, bool drawn)
{
    const struct blurs near = blurs_in(r, around_lamp(r, lamp, 2));
    int sum = 0, weight = 0, least = INT16_MAX, most = INT16_MIN;

    lamp->edges = 0;
    for (int i = 0, x, y; i < lamp->count; i++) {
        int blur, size, shines = 256;

        if (!place_of(r, lamp, i, &x, &y))
            continue;
        blur = r->front.blur[y * r->stride + x];
        size = abs(blur);
        if (near.sharpest < size - EDGE_FROM)
            shines = rf_lamp_shine(r, x, y);
        if (shines < (drawn ? 256 : 128))
            lamp->edges |= (uint16_t)(1 << i);
        if (shines == 0)
            continue;
        note_reach(r, x, y, drawn ? disc_reach(size) : size);
        least = blur < least ? blur : least;
        most = blur > most ? blur : most;
        sum += shines * blur;
        weight += shines;
    }
    lamp->blur = (int16_t)(weight ? sum / weight : 0);
    lamp->shining = (uint16_t)weight;
    if (most - least > rf_blurs_alike(least))
        lamp->blur = (int16_t)(drawn ? blur_of_most(r, lamp) : RF_NO_BLUR);
    lamp->rows = 1;
    lamp->below = 0;
    lamp->own[0] = lamp->own[1] = lamp->own[2] = 0;
}

static bool is_even(const struct rf_highlight *lamp)
{
    return lamp->rows == 1 && lamp->shining && lamp->blur != RF_NO_BLUR;
}

/* Of the next row, what of the same lamp is under a run; NULL: nothing as wide and as blurred. */
static struct rf_highlight *find_below(struct rf_highlight *lamp, const struct rf_highlight *end)
{
    const int last = lamp->x + lamp->count;

    for (struct rf_highlight *under = lamp + 1;
         under < end && under <= lamp + UINT8_MAX && under->y <= lamp->y + 1; under++)
        if (under->y > lamp->y && is_even(under) && abs(under->x - lamp->x) <= 2 &&
            abs(under->x + under->count - last) <= 2 &&
            abs(under->blur - lamp->blur) <= rf_blurs_alike(lamp->blur) / 2)
            return under;
    return NULL;
}

/* The larger a disc, the less it shows that rows beside each other are drawn as one: which those
 * are depends on where they are in the photo, not in the window. */
static void stack(const struct rf_highlights *found)
{
    const struct rf_highlight *const end = found->lamp + found->count;

    for (struct rf_highlight *top = found->lamp; top < end; top++) {
        const int size = abs(top->blur);
        const int most = size < STACKED ? 1 : size < 2 * STACKED ? 2 : RF_LAMP_STACK;
        struct rf_highlight *lowest = top, *under;

        if (!is_even(top))
            continue;
        while ((lowest->y & (most - 1)) != most - 1 && (under = find_below(lowest, end))) {
            lowest->below = (uint8_t)(under - lowest);
            under->rows = 0;
            top->rows++;
            lowest = under;
        }
    }
}

bool rf_mark_highlights(struct refocus_renderer *r, bool drawn)
{
    bool any = false;

    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r) && !rf_cancelled(r); part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];

        for (uint32_t i = 0; i < found->count; i++)
            mark(r, &found->lamp[i], drawn);
        if (drawn)
            stack(found);
        any = any || found->count;
    }
    return any;
}

/* Of lamps that rays lie so far apart at that few meet them, and show them as dots. */
static void note_dots(struct refocus_renderer *r, const struct rf_highlight *lamp, double gap)
{
    const double dots = lamp->size * 256 / (DOTS * gap); /* from this blur on */

    for (int i = 0, x, y; i < lamp->count; i++) {
        struct rf_bins *bins;
        int blur;

        if (!place_of(r, lamp, i, &x, &y) || is_left_alone(lamp, i))
            continue;
        bins = &r->bins[(size_t)(y / RF_TILE) * r->tiles_x + x / RF_TILE];
        blur = abs(r->front.blur[y * r->stride + x]);
        if (blur > dots && blur > bins->dots)
            bins->dots = (int16_t)blur;
    }
}

static void widen_all(struct refocus_renderer *r, const struct rf_highlight *lamp,
                      struct rf_bin_scale scale, double gap)
{
    const struct blurs near = blurs_in(r, around_lamp(r, lamp, WIDEST));

    if (near.most - near.least <= ALIKE)
        return;
    for (int i = 0, x, y; i < lamp->count; i++)
        if (place_of(r, lamp, i, &x, &y) && !is_left_alone(lamp, i) &&
            near.most > r->front.blur[y * r->stride + x] + ALIKE)
            widen(r, x, y, scale, gap);
}

void rf_widen_highlights(struct refocus_renderer *r, struct rf_bin_scale scale, double gap)
{
    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r) && !rf_cancelled(r); part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];

        for (uint32_t i = 0; i < found->count; i++)
            note_dots(r, &found->lamp[i], gap);
        for (uint32_t i = 0; i < found->count; i++)
            widen_all(r, &found->lamp[i], scale, gap);
    }
}

static void put_in_front(struct refocus_renderer *r, const struct rf_highlight *lamp, double gap)
{
    for (int i = 0, x, y; i < lamp->count; i++) {
        int reach;

        if (!place_of(r, lamp, i, &x, &y) || is_left_alone(lamp, i))
            continue;
        reach = 1 + reach_of(r->front.blur[y * r->stride + x], gap);
        rf_put_in_front(r, (struct rf_rect){x - reach, y - reach, x + reach, y + reach});
    }
}

void rf_put_lamps_in_front(struct refocus_renderer *r, double gap)
{
    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];

        for (uint32_t i = 0; i < found->count; i++)
            put_in_front(r, &found->lamp[i], gap);
    }
}

/* What pixel i of a lamp, at `at`, gets of a share of what it lost, Q8 of what is `added`. */
static void gain_of(const struct refocus_renderer *r, const struct rf_highlight *lamp, int i,
                    ptrdiff_t at, int share, int gained[3])
{
    /* from half a pixel of blur on, all of it from one pixel and a half on */
    const int blurred = is_left_alone(lamp, i) ? 0 : rf_ramp(abs(r->front.blur[at]), 128, 384);

    for (int c = 0; c < 3; c++)
        gained[c] = (((lamp->added[c] * share) >> 8) * blurred) >> 8;
}

/* Places within `reach` of (cx, cy) that have its blur, at most (2 WIDEST + 1)^2; it
 * itself at least. */
static int places_of(const struct refocus_renderer *r, int cx, int cy, int reach,
                     ptrdiff_t place[(2 * WIDEST + 1) * (2 * WIDEST + 1)])
{
    const int own = r->front.blur[cy * r->stride + cx];
    int count = 0;

    for (int y = cy - reach; y <= cy + reach; y++) {
        for (int x = cx - reach; x <= cx + reach; x++) {
            const int dx = x - cx, dy = y - cy;
            const ptrdiff_t at = y * r->stride + x;

            if (x >= 0 && y >= 0 && x < r->width && y < r->height &&
                dx * dx + dy * dy <= reach * reach + 1 &&
                abs(r->front.blur[at] - own) <= 256)
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
    const int tx0 = rf_within(x - reach, r->width - 1) / RF_TILE;
    const int tx1 = rf_within(x + reach, r->width - 1) / RF_TILE;
    const int ty0 = rf_within(y - reach, r->height - 1) / RF_TILE;
    const int ty1 = rf_within(y + reach, r->height - 1) / RF_TILE;

    for (int ty = ty0; ty <= ty1; ty++)
        for (int tx = tx0; tx <= tx1; tx++) {
            struct rf_bins *bins = &r->bins[(size_t)ty * r->tiles_x + tx];

            bins->brightest = (uint16_t)(light > bins->brightest ? light : bins->brightest);
        }
}

/* Pixel i of a lamp. */
static void add_spread(struct refocus_renderer *r, const struct rf_highlight *lamp, int i,
                       int share, double gap, int most)
{
    const int planes = r->yuv.on ? 1 : 3; /* of Y, U and V all three are one */
    ptrdiff_t place[(2 * WIDEST + 1) * (2 * WIDEST + 1)], at;
    int x, y, reach, places, gained[3], brightest = 0;

    if (!place_of(r, lamp, i, &x, &y))
        return;
    at = y * r->stride + x;
    reach = spread_of(lamp, r->front.blur[at], gap);
    places = places_of(r, x, y, reach, place);
    gain_of(r, lamp, i, at, share, gained);
    for (int k = 0; k < places; k++) {
        for (int c = 0; c < planes; c++) {
            const int sum = r->smooth[c][place[k]] + (gained[c] + places / 2) / places;
            const int light = sum < most ? sum : most;

            r->smooth[c][place[k]] = (uint16_t)light;
            brightest = light > brightest ? light : brightest;
        }
    }
    note_light(r, x, y, reach, brightest);
}

void rf_add_highlights(struct refocus_renderer *r, float gain, double gap, int most)
{
    const int share = (int)((gain - 1) * (256 / 3) + 0.5f); /* Q8, of what is three times white */

    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];

        for (uint32_t i = 0; i < found->count; i++)
            for (int k = 0; k < found->lamp[i].count; k++)
                add_spread(r, &found->lamp[i], k, share, gap, most);
    }
}
