/* subtract.c: subtracts from the light of the rays what splatted highlights have beyond their
 * surroundings. */
#include "highlights/highlights.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "highlights/clipped.h"
#include "highlights/in_window.h"
#include "support/compare.h"

enum {
    SOME_FROM = 512, /* Q7.8: from this blur on some of it is subtracted; discs have fewer rays than
                        pixels there, or so */
    ALL_FROM = 1024, /* Q7.8: from this blur on all of it is subtracted */
};

/* Runs side by side in a row, which have the same pixels on either side. */
struct chain {
    struct rf_highlight *first;
    int count;
    int y, left, right; /* in the window: the pixels beside them */
};

static struct chain chain_of(const struct rf_viewport *view, struct rf_highlight *run,
                             const struct rf_highlight *end)
{
    struct chain chain = {run, 1, run->y - view->y0, run->x - view->x0 - 1, 0};
    int next = run->x + run->count;

    for (run++; run < end && run->y == chain.first->y && run->x == next; run++) {
        next += run->count;
        chain.count++;
    }
    chain.right = next - view->x0;
    return chain;
}

/* Enough rays hit wide ones, which may be in part beyond the window; what is there is not known,
 * and repeats what is at the photo's sides. */
static bool may_subtract(const struct rf_viewport *view, const struct chain *chain)
{
    return chain->right - chain->left <= RF_HIGHLIGHT_RUN + 1 && chain->left >= 0 &&
           chain->right < view->width && chain->y > 0 && chain->y < view->height - 1;
}

static bool is_blurred(const struct rf_blur_q8 *plane, const struct chain *chain)
{
    const int16_t *const blur = plane->at + chain->y * plane->stride;
    int most = 0;

    for (int x = chain->left + 1; x < chain->right; x++)
        most = rf_larger(most, abs(blur[x]));
    return most > SOME_FROM;
}

struct subtract {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    struct rf_light_q12 out;
    int first, step; /* parts from `first` on, every `step`th */
    bool copies;     /* copies what the others change; else subtracts */
};

/* Copies a tile of the light, and a pixel around it. */
static void copy_tile(const struct subtract *s, int tx, int ty)
{
    const struct rf_highlight_window *w = s->window;
    struct rf_bins *bins = &w->bins[(size_t)ty * w->view->tiles_x + tx];

    if (bins->subtracted)
        return;
    bins->subtracted = true;
    for (int c = 0; c < w->channels; c++)
        for (int y = ty * RF_TILE - 1; y <= (ty + 1) * RF_TILE; y++) {
            const ptrdiff_t at = y * w->light.stride + tx * RF_TILE - 1;

            memcpy(s->out.channel[c] + at, w->light.channel[c] + at,
                   (RF_TILE + 2) * sizeof(uint16_t));
        }
}

/* Copies the tiles whose pixels the pre-filter mixes with those of the runs. */
static void copy_around(const struct subtract *s, const struct chain *chain)
{
    for (int ty = (chain->y - 1) / RF_TILE; ty <= (chain->y + 1) / RF_TILE; ty++)
        for (int tx = chain->left / RF_TILE; tx <= chain->right / RF_TILE; tx++)
            copy_tile(s, tx, ty);
}

/* Subtracts from the copy; notes how much that was, of each channel. */
static void subtract_run(const struct subtract *s, struct rf_highlight *run,
                         const struct chain *chain)
{
    const struct rf_highlight_window *w = s->window;
    const int x = run->x - w->view->x0;
    const ptrdiff_t row = chain->y * w->light.stride;
    int share[RF_HIGHLIGHT_RUN];

    static_assert(RF_LIGHT_MAX * 256 * 256 <= INT32_MAX, "light times two shares in Q8");
    static_assert(RF_HIGHLIGHT_RUN * RF_LIGHT_MAX * 256 <= INT32_MAX, "the sum of a run in Q8");
    static_assert(RF_HIGHLIGHT_RUN * 256 <= UINT16_MAX, "the weight of a run");
    if (!run->weight)
        return;
    for (int i = 0; i < run->count; i++) {
        const int weight = rf_is_edge(run, i) ? rf_edge_weight(w, x + i, chain->y) : 256;

        share[i] = weight *
                   rf_ramp(abs(w->blur.at[chain->y * w->blur.stride + x + i]), SOME_FROM, ALL_FROM);
    }
    for (int c = 0; c < w->channels; c++) {
        const uint16_t *const light = w->light.channel[c] + row;
        const int around = (light[chain->left] + light[chain->right] + 1) / 2;
        int sum = 0;

        for (int i = 0; i < run->count; i++) {
            const int more = rf_larger(light[x + i] - around, 0);
            const int part = (more * share[i]) >> 16;

            s->out.channel[c][row + x + i] = (uint16_t)(light[x + i] - part);
            sum += part;
        }
        run->subtracted[c] = (uint16_t)(256 * sum / run->weight);
    }
}

static void subtract_part(void *context, int item, int worker)
{
    const struct subtract *s = context;
    const struct rf_highlight_window *w = s->window;
    const struct rf_highlight_list *list = &w->highlights->part[s->first + item * s->step];
    struct rf_highlight *run = list->run, *const end = run + list->count;

    (void)worker;
    for (uint32_t n = 0; run < end; n++) {
        const struct chain chain = chain_of(w->view, run, end);

        if (rf_cancelled_at(s->exec, n))
            return;
        run += chain.count;
        if (!may_subtract(w->view, &chain) || !is_blurred(&w->blur, &chain))
            continue;
        if (s->copies)
            copy_around(s, &chain);
        for (int i = 0; !s->copies && i < chain.count; i++)
            subtract_run(s, &chain.first[i], &chain);
    }
}

/* All are copied before any is subtracted. The tiles that a part copies reach into the parts beside
 * it, which are not copied at the same time. */
void rf_subtract_highlights(const struct rf_executor *exec,
                            const struct rf_highlight_window *window, struct rf_light_q12 out)
{
    const struct rf_highlight_parts parts = rf_parts_in(window->view);
    struct subtract even = {exec, window, out, parts.first, 2, true}, odd = even, all = even;

    if (!rf_has_highlights(window->highlights, window->view))
        return;
    odd.first++;
    all.step = 1;
    all.copies = false;
    rf_pool_run(exec->pool, subtract_part, &even, (parts.count + 1) / 2);
    rf_pool_run(exec->pool, subtract_part, &odd, parts.count / 2);
    rf_pool_run(exec->pool, subtract_part, &all, parts.count);
}
