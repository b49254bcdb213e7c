/* mark.c: marks, for a lens setting, which pixels of highlights are silhouettes of others, how far
 * they are out of focus, and which rows are splatted as one. */
#include "highlights/highlights.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "highlights/in_window.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    EDGE_FROM = 128,  /* Q7.8: something bright is the edge of a highlight if it is sharper by this,
                         at least */
    EDGE_PART = 16,   /* it is also sharper by this part of the highlight's blur at least, wholly so
                         by 3 times that part; where highlights are gathered, by twice that */
    DISC_EDGE = 256,  /* Q7.8: what a disc goes beyond the blur of a highlight's pixel, half a pixel
                         at its edge and half of what blurs of a run may differ by, and some */
    STACKED = 4096,   /* Q7.8: from this blur on two rows of a highlight are splatted as one, from
                         twice that on four */
    STACK_EDGE = 512, /* Q7.8: stacked rows reach farther by this at most, as their ends differ */
};

/* How much sharper than it the sharpest bright pixel beside (x, y) is, Q7.8. If by a pixel of blur,
 * this one is the edge of that, and only its depth says otherwise. */
static int edge_of(const struct rf_highlight_window *w, int x, int y)
{
    const int own = abs(rf_window_blur(w, x, y));
    int sharpest = own;

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const int v = rf_within(y + j, w->view->height - 1);
            const int u = rf_within(x + i, w->view->width - 1);
            const int blur = abs(rf_window_blur(w, u, v));

            if (blur < sharpest &&
                rf_brightest_at(&w->light, v * w->light.stride + u) >= RF_CLIPPED)
                sharpest = blur;
        }
    }
    return own - sharpest;
}

int rf_edge_weight(const struct rf_highlight_window *w, int x, int y)
{
    const int size = abs(rf_window_blur(w, x, y));
    const int from = rf_larger(EDGE_FROM, size / EDGE_PART);

    return 256 - rf_ramp(edge_of(w, x, y), from, 3 * from);
}

/* How far the disc of a pixel so blurred may reach where it is splatted with others. */
static int disc_reach(int size)
{
    return size + DISC_EDGE + (size < STACKED ? 0 : STACK_EDGE);
}

static void note_reach(const struct rf_highlight_window *w, int x, int y, int reach)
{
    struct rf_bins *bins = &w->bins[(size_t)(y / RF_TILE) * w->view->tiles_x + x / RF_TILE];

    bins->highlight = (int16_t)rf_larger(rf_in_units(reach + (1 << w->blur.unit) - 1, w->blur.unit),
                                         bins->highlight);
}

enum { NONE = INT_MIN /* in place of a blur, of pixels whose blurs differ */ };

/* The mean blur of those pixels of a run that are blurred as its middle is, if that is two thirds
 * of its weight: the rest, its silhouette with the depth of what is beside it, belongs to it as
 * well. */
static int blur_of_most(const struct rf_highlight_window *w, const struct rf_highlight *run)
{
    int x, y, middle, sum = 0, weight = 0, reach;

    if (!rf_place_in(w->view, run, run->count / 2, &x, &y))
        return NONE;
    middle = rf_window_blur(w, x, y);
    for (int i = 0; i < run->count; i++) {
        const int own = !rf_place_in(w->view, run, i, &x, &y) ? 0
                        : rf_is_edge(run, i)                  ? rf_edge_weight(w, x, y)
                                                              : 256;
        const int blur = own ? rf_window_blur(w, x, y) : 0;

        if (own && 2 * abs(blur - middle) <= rf_alike_within(middle)) {
            sum += own * blur;
            weight += own;
        }
    }
    if (3 * weight < 2 * run->weight || !weight)
        return NONE;
    reach = disc_reach(abs(sum / weight));
    for (int i = 0; i < run->count; i++)
        if (rf_place_in(w->view, run, i, &x, &y))
            note_reach(w, x, y, reach);
    return sum / weight;
}

static void mark(const struct rf_highlight_window *w, struct rf_highlight *run, bool splat)
{
    const struct rf_blur_extent near = rf_blur_extent(&w->blur, rf_around_run(w->view, run, 2));
    int sum = 0, weight = 0, least = INT_MAX, most = INT_MIN, blur_of_all;

    run->edges = 0;
    for (int i = 0, x, y; i < run->count; i++) {
        int blur, size, own = 256;

        if (!rf_place_in(w->view, run, i, &x, &y))
            continue;
        blur = rf_window_blur(w, x, y);
        size = abs(blur);
        if (near.sharpest < size - EDGE_FROM)
            own = rf_edge_weight(w, x, y);
        if (own < (splat ? 256 : 128))
            run->edges |= (uint16_t)(1 << i);
        if (own == 0)
            continue;
        note_reach(w, x, y, splat ? disc_reach(size) : size);
        least = blur < least ? blur : least;
        most = blur > most ? blur : most;
        sum += own * blur;
        weight += own;
    }
    run->weight = (uint16_t)weight;
    blur_of_all = weight ? sum / weight : 0;
    if (weight && most - least > rf_alike_within(least))
        blur_of_all = splat ? blur_of_most(w, run) : NONE;
    run->blur = (int16_t)(blur_of_all == NONE ? RF_NO_BLUR : blur_of_all / (1 << w->blur.unit));
    run->rows = 1;
    run->below = 0;
    run->subtracted[0] = run->subtracted[1] = run->subtracted[2] = 0;
}

static bool is_even(const struct rf_highlight *run)
{
    return run->rows == 1 && run->weight && run->blur != RF_NO_BLUR;
}

/* The run of the same highlight in the next row; NULL: none there is as wide and as blurred. */
static struct rf_highlight *find_below(struct rf_highlight *run, const struct rf_highlight *end,
                                       int unit)
{
    const int last = run->x + run->count;
    const int within = rf_alike_within(rf_in_pixels(run->blur, unit)) / 2;

    for (struct rf_highlight *under = run + 1;
         under < end && under <= run + UINT8_MAX && under->y <= run->y + 1; under++)
        if (under->y > run->y && is_even(under) && abs(under->x - run->x) <= 2 &&
            abs(under->x + under->count - last) <= 2 &&
            rf_in_pixels(abs(under->blur - run->blur), unit) <= within)
            return under;
    return NULL;
}

/* The larger a disc, the less it shows that rows beside each other are splatted as one: which rows
 * these are depends on where they are in the photo, not in the window. */
static void stack(const struct rf_highlight_list *list, int unit)
{
    const struct rf_highlight *const end = list->run + list->count;

    for (struct rf_highlight *top = list->run; top < end; top++) {
        const int size = rf_in_pixels(abs(top->blur), unit);
        const int most = size < STACKED ? 1 : size < 2 * STACKED ? 2 : RF_HIGHLIGHT_STACK;
        struct rf_highlight *lowest = top, *under;

        if (!is_even(top))
            continue;
        while ((lowest->y & (most - 1)) != most - 1 && (under = find_below(lowest, end, unit))) {
            lowest->below = (uint8_t)(under - lowest);
            under->rows = 0;
            top->rows++;
            lowest = under;
        }
    }
}

struct marks {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    int first; /* part */
    bool splat;
};

/* A part begins with a row of tiles, so that no other one writes to the bins of its tiles. */
static void mark_part(void *context, int item, int worker)
{
    const struct marks *marks = context;
    const struct rf_highlight_list *list = &marks->window->highlights->part[marks->first + item];

    (void)worker;
    for (uint32_t i = 0; i < list->count; i++) {
        if (rf_cancelled_at(marks->exec, i))
            return;
        mark(marks->window, &list->run[i], marks->splat);
    }
    if (marks->splat)
        stack(list, marks->window->blur.unit);
}

void rf_mark_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                        bool splat)
{
    const struct rf_highlight_parts parts = rf_parts_in(window->view);
    struct marks marks = {exec, window, parts.first, splat};

    if (rf_has_highlights(window->highlights, window->view))
        rf_pool_run(exec->pool, mark_part, &marks, parts.count);
}
