/* marks.c: for a lens, which lamps are the edges of others, how they are blurred and which rows of
 * them are drawn as one. */
#include "highlights/highlights.h"

#include <stdbool.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "highlights/runs.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/compare.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    EDGE_FROM = 128, /* Q7.8: what something bright is sharper by for this to be its edge, */
    EDGE_PART = 16,  /* by that part of this blur at least, and wholly so by 3 times that; where
                        lamps are not drawn, by twice that */
    DISC_RIM = 256, /* Q7.8: what a disc goes beyond the blur of a lamp's pixel, half a pixel at its
                       rim and half of what blurs of a run may differ by, and some */
    STACKED = 4096, /* Q7.8: from this blur on two rows of a lamp are drawn as one, from twice that
                       on four, */
    STACK_RIM = 512, /* which may reach farther by what rows differ by at their ends */
};

/* How much sharper than it the sharpest bright pixel beside (x, y) is, Q7.8. If by a pixel of blur,
 * this one is the edge of that, and only its depth says otherwise. */
static int edge_of(const struct refocus_renderer *r, int x, int y)
{
    const int own = abs(r->blur.at[y * r->view.stride + x]);
    int sharpest = own;

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const ptrdiff_t at = rf_within(y + j, r->view.height - 1) * r->view.stride +
                                 rf_within(x + i, r->view.width - 1);
            const int blur = abs(r->blur.at[at]);

            if (blur < sharpest && rf_brightest_at(r, at) >= RF_CLIPPED)
                sharpest = blur;
        }
    }
    return own - sharpest;
}

int rf_first_lamp_part(const struct refocus_renderer *r)
{
    return r->view.y0 / RF_LAMP_ROWS;
}

int rf_last_lamp_part(const struct refocus_renderer *r)
{
    return (r->view.y0 + r->view.height - 1) / RF_LAMP_ROWS;
}

int rf_lamp_shine(const struct refocus_renderer *r, int x, int y)
{
    const int size = abs(r->blur.at[y * r->view.stride + x]);
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
    struct rf_bins *bins = &r->bins[(size_t)(y / RF_TILE) * r->view.tiles_x + x / RF_TILE];

    bins->lamp = (int16_t)rf_larger(reach, bins->lamp);
}

/* The mean blur of what of a run is blurred as its middle is, if that is two thirds of what
 * shines: the rest, its rim with the depth of what is beside it, belongs to it as well. */
static int blur_of_most(struct refocus_renderer *r, const struct rf_highlight *lamp)
{
    int x, y, middle, sum = 0, weight = 0, reach;

    if (!rf_place_of(r, lamp, lamp->count / 2, &x, &y))
        return RF_NO_BLUR;
    middle = r->blur.at[y * r->view.stride + x];
    for (int i = 0; i < lamp->count; i++) {
        const int shines = !rf_place_of(r, lamp, i, &x, &y) ? 0
                           : lamp->edges >> i & 1           ? rf_lamp_shine(r, x, y)
                                                            : 256;
        const int blur = shines ? r->blur.at[y * r->view.stride + x] : 0;

        if (shines && 2 * abs(blur - middle) <= rf_blurs_alike(middle)) {
            sum += shines * blur;
            weight += shines;
        }
    }
    if (3 * weight < 2 * lamp->shining || !weight)
        return RF_NO_BLUR;
    reach = disc_reach(abs(sum / weight));
    for (int i = 0; i < lamp->count; i++)
        if (rf_place_of(r, lamp, i, &x, &y))
            note_reach(r, x, y, reach);
    return sum / weight;
}

static void mark(struct refocus_renderer *r, struct rf_highlight *lamp, bool drawn)
{
    const struct rf_blurs near = rf_blurs_in(r, rf_around_run(r, lamp, 2));
    int sum = 0, weight = 0, least = INT16_MAX, most = INT16_MIN;

    lamp->edges = 0;
    for (int i = 0, x, y; i < lamp->count; i++) {
        int blur, size, shines = 256;

        if (!rf_place_of(r, lamp, i, &x, &y))
            continue;
        blur = r->blur.at[y * r->view.stride + x];
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

struct marks {
    struct refocus_renderer *r;
    bool drawn;
};

/* Of the window's parts. A part begins with a row of tiles, so that no other notes in its tiles. */
static void mark_part(void *context, int item, int worker)
{
    const struct marks *marks = context;
    struct refocus_renderer *r = marks->r;
    const struct rf_highlights *found = &r->photo.highlights[rf_first_lamp_part(r) + item];

    (void)worker;
    for (uint32_t i = 0; i < found->count; i++) {
        if (rf_cancelled_at(&r->exec, i))
            return;
        mark(r, &found->lamp[i], marks->drawn);
    }
    if (marks->drawn)
        stack(found);
}

bool rf_has_highlights(const struct refocus_renderer *r)
{
    for (int part = rf_first_lamp_part(r); part <= rf_last_lamp_part(r); part++)
        if (r->photo.highlights[part].count)
            return true;
    return false;
}

bool rf_mark_highlights(struct refocus_renderer *r, bool drawn)
{
    struct marks marks = {r, drawn};

    if (!rf_has_highlights(r))
        return false;
    rf_pool_run(&r->pool, mark_part, &marks, rf_lamp_parts_in(r));
    return true;
}
