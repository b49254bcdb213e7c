/* mark.c: marks, for a lens setting, how far highlights are out of focus and which rows of them are
 * splatted as one. */
#include "highlights/highlights.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

#include "highlights/in_window.h"
#include "support/compare.h"
#include "support/places.h"

enum {
    DISC_EDGE = 256,  /* Q7.8: what a disc goes beyond the blur of a highlight's pixel, half a pixel
                         at its edge and half of what blurs of a run may differ by, and some */
    STACKED = 4096,   /* Q7.8: from this blur on two rows of a highlight are splatted as one, from
                         twice that on four */
    STACK_EDGE = 512, /* Q7.8: stacked rows reach farther by this at most, as their ends differ */
    END_STEP = 2,     /* pixels that the ends of stacked rows are apart at most, from row to row */
};

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

/* The mean blur of those pixels of a run that are blurred as its middle is, if these are two thirds
 * of it: the rest, its silhouette with the depth of what is beside it, belongs to it as well. Else
 * RF_NO_BLUR. */
static int blur_of_most(const struct rf_highlight_window *w, const struct rf_highlight *run)
{
    int x, y, middle, within, sum = 0, count = 0, reach;

    if (!rf_place_in(w->view, run, run->count / 2, &x, &y))
        return RF_NO_BLUR;
    middle = rf_window_blur(w, x, y);
    within = rf_alike_within(w, x, y, middle);
    for (int i = 0; i < run->count; i++) {
        int blur;

        if (!rf_place_in(w->view, run, i, &x, &y))
            continue;
        blur = rf_window_blur(w, x, y);
        if (2 * abs(blur - middle) <= within) {
            sum += blur;
            count++;
        }
    }
    if (3 * count < 2 * run->pixels || !count)
        return RF_NO_BLUR;
    reach = disc_reach(abs(sum / count));
    for (int i = 0; i < run->count; i++)
        if (rf_place_in(w->view, run, i, &x, &y))
            note_reach(w, x, y, reach);
    return sum / count / (1 << w->blur.unit);
}

static void mark(const struct rf_highlight_window *w, struct rf_highlight *run, bool splat)
{
    int sum = 0, least = INT_MAX, most = INT_MIN, within = 0;

    run->pixels = 0;
    for (int i = 0, x, y; i < run->count; i++) {
        int blur;

        if (!rf_place_in(w->view, run, i, &x, &y))
            continue;
        blur = rf_window_blur(w, x, y);
        note_reach(w, x, y, splat ? disc_reach(abs(blur)) : abs(blur));
        least = rf_smaller(least, blur);
        most = rf_larger(most, blur);
        if (!run->pixels++)
            within = rf_alike_within(w, x, y, blur);
        sum += blur;
    }
    if (run->pixels && most - least > within)
        run->blur = (int16_t)(splat ? blur_of_most(w, run) : RF_NO_BLUR);
    else
        run->blur = (int16_t)((run->pixels ? sum / run->pixels : 0) / (1 << w->blur.unit));
    run->rows = 1;
    run->below = 0;
    run->subtracted[0] = run->subtracted[1] = run->subtracted[2] = 0;
}

static bool is_even(const struct rf_highlight *run)
{
    return run->rows == 1 && run->pixels && run->blur != RF_NO_BLUR;
}

/* The run of the same highlight in the next row; NULL: none there is as wide and as blurred. */
static struct rf_highlight *find_below(const struct rf_highlight_window *w,
                                       struct rf_highlight *run, const struct rf_highlight *end)
{
    const int last = run->x + run->count, unit = w->blur.unit;
    const int middle = rf_within(run->x + run->count / 2 - w->view->x0, w->view->width - 1);
    const int within =
        rf_alike_within(w, middle, run->y - w->view->y0, rf_in_pixels(run->blur, unit)) / 2;
    struct rf_highlight *under = rf_first_run(run + 1, end, run->x - END_STEP, run->y + 1);

    for (; under < end && under->y == run->y + 1 && under->x <= run->x + END_STEP; under++)
        if (is_even(under) && abs(under->x + under->count - last) <= END_STEP &&
            rf_in_pixels(abs(under->blur - run->blur), unit) <= within)
            return under;
    return NULL;
}

/* The larger a disc, the less it shows that rows beside each other are splatted as one: which rows
 * these are depends on where they are in the photo, not in the window. */
static void stack(const struct rf_highlight_window *w, const struct rf_highlight_list *list)
{
    const struct rf_highlight *const end = list->run + list->count;

    for (struct rf_highlight *top = list->run; top < end; top++) {
        const int size = rf_in_pixels(abs(top->blur), w->blur.unit);
        const int most = size < STACKED ? 1 : size < 2 * STACKED ? 2 : RF_HIGHLIGHT_STACK;
        struct rf_highlight *lowest = top, *under;

        if (!is_even(top))
            continue;
        while ((lowest->y & (most - 1)) != most - 1 && (under = find_below(w, lowest, end))) {
            lowest->below = (uint16_t)(under - lowest);
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
        stack(marks->window, list);
}

void rf_mark_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                        bool splat)
{
    const struct rf_highlight_parts parts = rf_parts_in(window->view);
    struct marks marks = {exec, window, parts.first, splat};

    if (rf_has_highlights(window->highlights, window->view))
        rf_pool_run(exec->pool, mark_part, &marks, parts.count);
}
