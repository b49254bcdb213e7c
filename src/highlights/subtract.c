/* subtract.c: subtracts from the light of the rays what splatted highlights have beyond their
 * surroundings. */
#include "highlights/highlights.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "highlights/ramp.h"
#include "highlights/in_window.h"
#include "image/format.h"
#include "support/compare.h"

enum {
    SOME_FROM = 512, /* Q7.8: from this blur on some of it is subtracted; discs have fewer rays than
                        pixels there, or so */
    ALL_FROM = 1024, /* Q7.8: from this blur on all of it is subtracted */
    SAMPLED = 4,     /* gaps of the rays that wide ones are left to them from, in part, wholly from
                        half as much again: else their discs show the rays */
};

/* Runs side by side in a row, which have the same pixels on either side. Some of them may lie
 * beyond the window. */
struct chain {
    struct rf_highlight *first;
    int count;
    int y, left, right; /* the pixels beside them, from the window's first on */
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

/* Pixels beyond the photo repeat those at its sides. */
static bool may_subtract(const struct rf_viewport *view, const struct chain *chain)
{
    return chain->left + view->x0 >= 0 && chain->right + view->x0 < view->photo_width &&
           chain->y > 0 && chain->y < view->height - 1;
}

/* How much of a pixel of a chain is subtracted, Q8: nothing in focus, nothing of wide chains that
 * enough rays hit. */
static int share_of(const struct chain *chain, int blur, double gap)
{
    const int wide = 256 * (chain->right - chain->left - 1);
    const int sampled = rf_larger((int)(SAMPLED * gap * blur), 256 * RF_HIGHLIGHT_RUN);

    return rf_ramp(blur, SOME_FROM, ALL_FROM) *
           (256 - rf_ramp(wide, sampled, sampled + sampled / 2)) / 256;
}

struct subtract {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    const struct rf_photo_source *photo;
    struct rf_light_q12 out;
    double gap;      /* between rays, of the blur */
    int first, step; /* parts from `first` on, every `step`th */
    bool copies;     /* copies what the others change; else subtracts */
};

/* Whether anything of a chain in the window is subtracted. */
static bool is_blurred(const struct subtract *s, const struct chain *chain)
{
    const struct rf_highlight_window *w = s->window;
    const int16_t *const blur = w->blur.at + chain->y * w->blur.stride;
    int most = 0;

    for (int x = rf_larger(chain->left + 1, 0); x < rf_smaller(chain->right, w->view->width); x++)
        most = rf_larger(most, abs(blur[x]));
    return share_of(chain, rf_in_pixels(most, w->blur.unit), s->gap) > 0;
}

/* The light of a pixel of the photo in the row of a chain, which may lie beyond the window. */
static int light_at(const struct subtract *s, const struct chain *chain, int x, int c)
{
    const struct rf_highlight_window *w = s->window;
    const struct refocus_image *image = s->photo->image;
    struct rf_order order;
    const uint8_t *code;

    if (rf_has_planes(s->photo) || (x >= 0 && x < w->view->width))
        return w->light.channel[c][chain->y * w->light.stride + x];
    order = rf_order_of(image->format);
    code = image->plane[0] + (chain->y + w->view->y0) * image->stride[0] +
           (ptrdiff_t)(x + w->view->x0) * order.bytes;
    return s->photo->transfer->to_light[code[c == 0 ? order.r : c == 1 ? order.g : order.b]];
}

/* Copies a tile of the light, and a pixel around it. */
static void copy_tile(const struct subtract *s, int tx, int ty)
{
    const struct rf_highlight_window *w = s->window;
    struct rf_bins *bins = &w->bins[(size_t)ty * w->view->tiles_x + tx];

    if (bins->subtracted)
        return;
    bins->subtracted = true;
    for (int c = 0; c < rf_channels_of_light(w); c++)
        for (int y = ty * RF_TILE - 1; y <= (ty + 1) * RF_TILE; y++) {
            const ptrdiff_t at = y * w->light.stride + tx * RF_TILE - 1;

            memcpy(s->out.channel[c] + at, w->light.channel[c] + at,
                   (RF_TILE + 2) * sizeof(uint16_t));
        }
}

/* Copies the tiles whose pixels the pre-filter mixes with those of the runs. */
static void copy_around(const struct subtract *s, const struct chain *chain)
{
    const struct rf_viewport *view = s->window->view;

    for (int ty = (chain->y - 1) / RF_TILE; ty <= (chain->y + 1) / RF_TILE; ty++)
        for (int tx = rf_larger(chain->left, 0) / RF_TILE;
             tx <= rf_smaller(chain->right, view->width - 1) / RF_TILE; tx++)
            copy_tile(s, tx, ty);
}

/* Subtracts from the copy; notes how much that was, of each channel. */
static void subtract_run(const struct subtract *s, struct rf_highlight *run,
                         const struct chain *chain)
{
    const struct rf_highlight_window *w = s->window;
    const int x = run->x - w->view->x0;
    const ptrdiff_t row = chain->y * w->light.stride;
    const int first = rf_larger(-x, 0), end = rf_smaller(run->count, w->view->width - x);
    int share[RF_HIGHLIGHT_RUN];

    static_assert(RF_LIGHT_MAX * 256 <= INT32_MAX, "light times a share in Q8");
    if (!run->pixels)
        return;
    for (int i = first; i < end; i++)
        share[i] = share_of(chain, abs(rf_window_blur(w, x + i, chain->y)), s->gap);
    for (int c = 0; c < rf_channels_of_light(w); c++) {
        const uint16_t *const light = w->light.channel[c] + row;
        const int around =
            (light_at(s, chain, chain->left, c) + light_at(s, chain, chain->right, c) + 1) / 2;
        int sum = 0;

        for (int i = first; i < end; i++) {
            const int more = rf_larger(light[x + i] - around, 0);
            const int part = (more * share[i]) >> 8;

            s->out.channel[c][row + x + i] = (uint16_t)(light[x + i] - part);
            sum += part;
        }
        run->subtracted[c] = (uint16_t)(sum / run->pixels);
    }
    if (w->yuv) /* chroma stays, so that it was grey */
        run->subtracted[1] = run->subtracted[2] = run->subtracted[0];
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
        if (!may_subtract(w->view, &chain) || !is_blurred(s, &chain))
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
                            const struct rf_highlight_window *window,
                            const struct rf_photo_source *photo, double gap,
                            struct rf_light_q12 out)
{
    const struct rf_highlight_parts parts = rf_parts_in(window->view);
    struct subtract even = {exec, window, photo, out, gap, parts.first, 2, true}, odd = even,
                    all = even;

    if (!rf_has_highlights(window->highlights, window->view))
        return;
    odd.first++;
    all.step = 1;
    all.copies = false;
    rf_pool_run(exec->pool, subtract_part, &even, (parts.count + 1) / 2);
    rf_pool_run(exec->pool, subtract_part, &odd, parts.count / 2);
    rf_pool_run(exec->pool, subtract_part, &all, parts.count);
}
