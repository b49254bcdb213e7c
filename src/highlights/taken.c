/* taken.c: what drawn lamps have more than what is around them, kept from the rays. */
#include "highlights/draw.h"

#include <stdlib.h>
#include <string.h>

#include "highlights/clipped.h"
#include "highlights/highlights.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/compare.h"

enum {
    TAKEN_FROM = 512, /* Q7.8: blurs whose discs have fewer rays than pixels, or so:
                         from there on some of it is taken, */
    TAKEN_TO = 1024,  /* and all of it from here on */
};

/* Runs side by side in a row, which have the same on either side. */
struct chain {
    struct rf_highlight *first;
    int count;
    int y, left, right; /* in the window: the pixels beside them */
};

static struct chain chain_of(const struct refocus_renderer *r, struct rf_highlight *lamp,
                             const struct rf_highlight *end)
{
    struct chain chain = {lamp, 1, lamp->y - r->view.y0, lamp->x - r->view.x0 - 1, 0};
    int next = lamp->x + lamp->count;

    for (lamp++; lamp < end && lamp->y == chain.first->y && lamp->x == next; lamp++) {
        next += lamp->count;
        chain.count++;
    }
    chain.right = next - r->view.x0;
    return chain;
}

/* Wide ones are met by rays enough, and may be in part beyond the window; what is there
 * is not known, and repeats what is at the photo's sides. */
static bool may_take(const struct refocus_renderer *r, const struct chain *chain)
{
    return chain->right - chain->left <= RF_LAMP_RUN + 1 && chain->left >= 0 &&
           chain->right < r->view.width && chain->y > 0 && chain->y < r->view.height - 1;
}

static bool is_blurred(const struct refocus_renderer *r, const struct chain *chain)
{
    const int16_t *const blur = r->blur.at + chain->y * r->view.stride;
    int most = 0;

    for (int x = chain->left + 1; x < chain->right; x++)
        most = rf_larger(most, abs(blur[x]));
    return most > TAKEN_FROM;
}

static int planes_of(const struct refocus_renderer *r)
{
    return r->yuv.on ? 1 : 3;
}

/* A tile of the photo, and a pixel around it, to where the pre-filter takes it from. */
static void copy_tile(struct refocus_renderer *r, int tx, int ty)
{
    struct rf_bins *bins = &r->bins[(size_t)ty * r->view.tiles_x + tx];

    if (bins->taken)
        return;
    bins->taken = true;
    for (int c = 0; c < planes_of(r); c++)
        for (int y = ty * RF_TILE - 1; y <= (ty + 1) * RF_TILE; y++) {
            const ptrdiff_t at = y * r->view.stride + tx * RF_TILE - 1;

            memcpy(r->background.light.channel[c] + at, r->light.channel[c] + at,
                   (RF_TILE + 2) * sizeof(uint16_t));
        }
}

/* The tiles whose pixels the pre-filter mixes with those of the runs. */
static void copy_around(struct refocus_renderer *r, const struct chain *chain)
{
    for (int ty = (chain->y - 1) / RF_TILE; ty <= (chain->y + 1) / RF_TILE; ty++)
        for (int tx = chain->left / RF_TILE; tx <= chain->right / RF_TILE; tx++)
            copy_tile(r, tx, ty);
}

/* From the copy; notes how much that was, of each channel. */
static void take_run(struct refocus_renderer *r, struct rf_highlight *lamp,
                     const struct chain *chain)
{
    const int x = lamp->x - r->view.x0;
    const ptrdiff_t row = chain->y * r->view.stride;
    int share[RF_LAMP_RUN];

    if (!lamp->shining)
        return;
    for (int i = 0; i < lamp->count; i++) {
        const int shines = lamp->edges >> i & 1 ? rf_lamp_shine(r, x + i, chain->y) : 256;

        share[i] = shines * rf_ramp(abs(r->blur.at[row + x + i]), TAKEN_FROM, TAKEN_TO);
    }
    for (int c = 0; c < planes_of(r); c++) {
        const uint16_t *const light = r->light.channel[c] + row;
        const int around = (light[chain->left] + light[chain->right] + 1) / 2;
        int sum = 0;

        for (int i = 0; i < lamp->count; i++) {
            const int more = rf_larger(light[x + i] - around, 0);
            const int taken = (more * share[i]) >> 16;

            r->background.light.channel[c][row + x + i] = (uint16_t)(light[x + i] - taken);
            sum += taken;
        }
        lamp->own[c] = (uint16_t)(256 * sum / lamp->shining);
    }
}

/* A part of the window's: those from `first` on, every `step`th. */
struct taken {
    struct refocus_renderer *r;
    int first, step;
    bool copies; /* what the others change; else they take */
};

static void take_part(void *context, int item, int worker)
{
    const struct taken *taken = context;
    struct refocus_renderer *r = taken->r;
    const struct rf_highlights *found = &r->photo.highlights[taken->first + item * taken->step];
    struct rf_highlight *lamp = found->lamp, *const end = lamp + found->count;

    (void)worker;
    for (uint32_t n = 0; lamp < end; n++) {
        const struct chain chain = chain_of(r, lamp, end);

        if (rf_cancelled_at(&r->exec, n))
            return;
        lamp += chain.count;
        if (!may_take(r, &chain) || !is_blurred(r, &chain))
            continue;
        if (taken->copies)
            copy_around(r, &chain);
        for (int i = 0; !taken->copies && i < chain.count; i++)
            take_run(r, &chain.first[i], &chain);
    }
}

/* All are copied before any is taken: the tiles that a part copies reach into those beside it,
 * which are not copied at the same time. */
void rf_take_lamps_out(struct refocus_renderer *r)
{
    const int first = rf_first_lamp_part(r), parts = rf_lamp_parts_in(r);
    struct taken even = {r, first, 2, true}, odd = {r, first + 1, 2, true};
    struct taken all = {r, first, 1, false};

    if (!rf_has_highlights(r))
        return;
    rf_pool_run(&r->pool, take_part, &even, (parts + 1) / 2);
    rf_pool_run(&r->pool, take_part, &odd, parts / 2);
    rf_pool_run(&r->pool, take_part, &all, parts);
}
