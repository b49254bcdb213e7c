/* splat.c: draws highlights as sprites of the aperture into the means of a tile. */
#include "highlights/highlights.h"

#include <assert.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "aperture/aperture.h"
#include "highlights/in_window.h"
#include "highlights/known.h"
#include "highlights/sprite.h"
#include "highlights/visibility.h"
#include "kernels/kernels.h"
#include "support/bayer.h"
#include "support/compare.h"

enum {
    PAIRS = 8192, /* Q7.8: rows that are hidden in part are drawn by twos from this blur on */
};

bool rf_can_splat(const struct rf_settings *params, const struct refocus_aperture *aperture)
{
    return params->highlight_gain > 1 && (rf_aperture_is_disc(aperture) || aperture->chord_sets ||
                                          (aperture->summed && params->cat_eye == 0));
}

/* Light of a pixel, Q12: what clipping cost, and what was subtracted. */
static double light_of(const struct rf_splat *splat, const struct rf_highlight *run, int c)
{
    return run->boost[c] * (splat->gain - 1.0) / 3 + run->subtracted[c];
}

enum { LANES = RF_TILE * RF_TILE };

/* The means of a tile that highlights are drawn into. */
struct canvas {
    struct rf_visibility tile;
    const struct rf_splat *splat;
    uint16_t *const *mean;
    int even[3];              /* 1/256: light that all its pixels get alike, not yet added */
    uint16_t faint[3][LANES]; /* 1/256: light of faint sprites, not yet added */
    int filled;               /* a bound of that light; 0: it is not set */
};

/* Whether all pixels see the whole run. */
static bool is_even(const struct rf_disc_job *job)
{
    if (job->visible || job->first > 0 || job->end < RF_TILE)
        return false;
    for (int y = 0; y < RF_TILE; y++)
        if ((RF_SPLAT_UNIT >> job->unit) * (RF_TILE - 1) + job->left[y] > job->from ||
            job->right[y] < job->to)
            return false;
    return true;
}

/* Adds the whole steps of faint light to the means. The rest stays, so that the order of sprites
 * does not count. */
static void flush_faint(struct canvas *canvas)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++) {
            const int light = canvas->faint[c][i];

            canvas->mean[c][i] =
                (uint16_t)rf_smaller(canvas->mean[c][i] + (light >> 8), UINT16_MAX);
            canvas->faint[c][i] = (uint16_t)(light & 255);
        }
    canvas->filled = 256;
}

/* Makes room for faint light of one more sprite. */
static void make_room(struct canvas *canvas, int most)
{
    if (!canvas->filled)
        memset(canvas->faint, 0, sizeof canvas->faint);
    else if (canvas->filled + most > UINT16_MAX)
        flush_faint(canvas);
    canvas->filled = rf_larger(canvas->filled, 1) + most;
}

/* Adds a sprite as kernels->draw_disc does, which adds nothing below 0, so that the order does not
 * count. */
static void add_sprite(struct canvas *canvas, const struct rf_sprite *sprite,
                       const struct rf_splat_run *run)
{
    const struct rf_disc_job *const job = &sprite->job;
    const int seen = (job->to - job->from) << job->shift;
    uint16_t *mean[3];

    static_assert(INT16_MAX * INT16_MAX + (1 << 14) <= INT32_MAX, "of light and what is seen");
    if (!sprite->summed && is_even(job)) {
        for (int p = 0; p < job->planes; p++) {
            const int light = ((seen * job->each[p] + (1 << 14)) >> 15) * sprite->times;
            int *const even = &canvas->even[sprite->channel[p]];

            *even = rf_smaller(*even + light * (sprite->faint[p] ? 1 : 256), 256 * UINT16_MAX);
        }
        return;
    }
    for (int p = 0; p < job->planes; p++) {
        const int c = sprite->channel[p];

        if (sprite->faint[p])
            make_room(canvas, sprite->most[p] * sprite->times);
        mean[p] = sprite->faint[p] ? canvas->faint[c] : canvas->mean[c];
    }
    if (sprite->summed)
        rf_sprite_draw_summed(mean, sprite, canvas->splat, run);
    else
        for (int i = 0; i < sprite->times; i++)
            canvas->splat->exec->kernels->draw_disc(mean, job);
}

/* Adds what is not yet added, dithered: a faint sprite is but a few steps of Q14 bright, and would
 * gain or lose a part of its light if all of it were rounded alike. */
static void add_rest(const struct canvas *canvas)
{
    const int *const even = canvas->even;

    if (!canvas->filled && !even[0] && !even[1] && !even[2])
        return;
    for (int i = 0; i < LANES; i++) {
        const int threshold = rf_bayer(i % RF_TILE, i / RF_TILE, 4); /* 0 to 255 */

        for (int c = 0; c < 3; c++) {
            const int light = even[c] + (canvas->filled ? canvas->faint[c][i] : 0);

            canvas->mean[c][i] =
                (uint16_t)rf_smaller(canvas->mean[c][i] + ((light + threshold) >> 8), UINT16_MAX);
        }
    }
}

/* Draws a run in a layer, past all slabs but those that are clear. */
static void draw_layer(struct canvas *canvas, struct rf_splat_run run, int layer, uint64_t clear)
{
    struct rf_sprite sprite;

    rf_sprite_set_layer(&run, canvas->splat, layer);
    if (rf_sprite_make(&sprite, &canvas->tile, &run) &&
        rf_run_visible(&canvas->tile, &sprite.job, &run, clear))
        add_sprite(canvas, &sprite, &run);
}

static void draw(struct canvas *canvas, const struct rf_splat_run *run)
{
    for (int layer = 0; layer < rf_sprite_layers(canvas->splat); layer++)
        draw_layer(canvas, *run, layer, 0);
}

/* Puts `count` pixels of a row of the window in a run, from (x, y) on. */
static void place(struct rf_splat_run *run, const struct rf_visibility *tile, int x, int y,
                  int count)
{
    x -= tile->tx * RF_TILE;
    run->from = RF_SPLAT_UNIT * x - RF_SPLAT_UNIT / 2;
    run->to = run->from + RF_SPLAT_UNIT * count;
    run->middle = 2 * (y - tile->ty * RF_TILE);
    run->rows = 1;
    run->turn = y;
}

static void set_blur(struct rf_splat_run *run, int blur)
{
    run->blur = blur;
    run->radius = abs(blur);
}

/* How many pixels of a run are drawn as one, all with their mean light. Much of a photo may be
 * above white, and its texture shows where discs are smaller than runs: so known light is drawn in
 * parts of a quarter of its disc. */
static int longest_part(const struct rf_splat *splat, int blur)
{
    return splat->window.known ? rf_larger(abs(blur) / 512, 1) : RF_HIGHLIGHT_RUN;
}

/* Makes a part of those pixels of a run that are equally far out of focus, from pixel i on, which
 * is in the window; returns how many these are. */
static int part_of(struct rf_splat_run *part, const struct rf_visibility *tile,
                   const struct rf_highlight *run, int i)
{
    const struct rf_highlight_window *w = &tile->splat->window;
    const int x = run->x - w->view->x0, y = run->y - w->view->y0;
    const int16_t *const blur = w->blur.at + y * w->blur.stride + x;
    const int first = i, end = rf_smaller(run->count, w->view->width - x);
    const int unit = w->blur.unit;
    int least = rf_in_pixels(blur[i], unit), most = least, sum = 0;
    const int longest = longest_part(tile->splat, least);
    const int within = rf_alike_within(w, x + i, y, least);

    for (; i < end && i - first < longest; i++) {
        least = rf_smaller(least, rf_in_pixels(blur[i], unit));
        most = rf_larger(most, rf_in_pixels(blur[i], unit));
        if (most - least > within)
            break;
        sum += rf_in_pixels(blur[i], unit);
    }
    place(part, tile, x + first, y, i - first);
    set_blur(part, sum / (i - first));
    if (w->known && longest < run->count) {
        rf_known_light(w->known, run, first, i, part->light);
        for (int c = 0; c < 3; c++)
            part->light[c] = (part->light[c] + run->subtracted[c] * (i - first)) * 256;
        return i - first;
    }
    for (int c = 0; c < 3; c++)
        part->light[c] = light_of(tile->splat, run, c) * 256 * (i - first);
    return i - first;
}

/* Whether the disc of any of pixels i to end - 1 of a run reaches the tile. */
static bool may_reach(const struct rf_visibility *tile, const struct rf_highlight *run, int i,
                      int end)
{
    const struct rf_highlight_window *w = &tile->splat->window;
    const int x = run->x - w->view->x0, y = run->y - w->view->y0;
    const int16_t *const blur = w->blur.at + y * w->blur.stride + x;
    struct rf_splat_run part;
    int most = 0;

    place(&part, tile, x + i, y, end - i);
    for (; i < end; i++)
        most = rf_larger(most, abs(blur[i]));
    set_blur(&part, rf_in_pixels(most, w->blur.unit));
    return rf_sprite_reaches(&part);
}

/* Draws a run that is not equally far out of focus, part by part. */
static void draw_parts(struct canvas *canvas, const struct rf_highlight *run)
{
    const struct rf_viewport *view = canvas->splat->window.view;
    const int x = run->x - view->x0, first = rf_larger(0, -x);
    const int end = rf_smaller(run->count, view->width - x);

    if (!may_reach(&canvas->tile, run, first, end))
        return;
    for (int i = first; i < end;) {
        struct rf_splat_run part;

        i += part_of(&part, &canvas->tile, run, i);
        draw(canvas, &part);
    }
}

/* Rows that are drawn as one, in their middle, as wide as they are in the mean. */
static struct rf_splat_run stack_of(const struct rf_visibility *tile,
                                    const struct rf_highlight *top, int rows)
{
    const struct rf_viewport *view = tile->splat->window.view;
    const struct rf_highlight *row = top;
    int x = 0, count = 0, blur = 0;
    struct rf_splat_run run = {.light = {0}};

    for (int k = 0; k < rows; k++, row += row->below) {
        x += row->x;
        count += row->count;
        blur += row->blur;
        for (int c = 0; c < 3; c++)
            run.light[c] += light_of(tile->splat, row, c) * 256 * row->pixels;
    }
    place(&run, tile, -view->x0, top->y - view->y0, 0);
    run.from += RF_SPLAT_UNIT * x / rows;
    run.to = run.from + RF_SPLAT_UNIT * count / rows;
    run.middle += rows - 1;
    run.rows = rows;
    run.turn = top->y / rows;
    set_blur(&run, rf_in_pixels(blur, tile->splat->window.blur.unit) / rows);
    return run;
}

/* Whether the top or the bottom of a sprite lies in the tile or just beside it. */
static bool has_end(const struct rf_disc_job *job)
{
    int least = INT_MAX, most = 0;

    if (job->first > 0 || job->end < RF_TILE)
        return true;
    for (int y = 0; y < RF_TILE; y++) {
        least = rf_smaller(least, job->right[y] - job->left[y]);
        most = rf_larger(most, job->right[y] - job->left[y]);
    }
    return 2 * least < most;
}

/* Draws them as one where nothing hides them; else in parts, for each to see past that by other
 * ways. At the ends of a sprite some rows have no chord, and with the mean of all of them it would
 * end in a point, which shows if it is as bright as known light may be: there each row is drawn by
 * itself, but for discs of wide areas, which have others beside and below them. */
static void draw_stack(struct canvas *canvas, const struct rf_highlight *top,
                       struct rf_splat_run run, int layer)
{
    const struct rf_highlight *row = top;
    enum rf_hidden hidden;
    struct rf_sprite sprite;
    uint64_t clear = 0;
    bool ends;
    int most;

    rf_sprite_set_layer(&run, canvas->splat, layer);
    if (!rf_sprite_make(&sprite, &canvas->tile, &run))
        return;
    hidden = rf_run_hidden(&canvas->tile, &sprite.job, &run, &clear);
    if (hidden == RF_HIDDEN_WHOLLY)
        return;
    ends = canvas->splat->window.known && has_end(&sprite.job) &&
           (top->size != UINT8_MAX || !rf_aperture_is_disc(canvas->splat->aperture));
    if (hidden == RF_HIDDEN_NOWHERE && !ends) {
        add_sprite(canvas, &sprite, &run);
        return;
    }
    most = ends || run.radius < PAIRS ? 1 : 2;
    for (int k = 0; k < top->rows; k += most) {
        const int rows = rf_smaller(most, top->rows - k);

        draw_layer(canvas, stack_of(&canvas->tile, row, rows), layer, clear);
        for (int i = 0; i < rows; i++)
            row += row->below;
    }
}

static void draw_highlight(struct canvas *canvas, const struct rf_highlight *top)
{
    struct rf_splat_run run;

    if (top->blur == RF_NO_BLUR ||
        (top->rows == 1 &&
         top->count > longest_part(canvas->splat,
                                   rf_in_pixels(top->blur, canvas->splat->window.blur.unit)))) {
        draw_parts(canvas, top);
        return;
    }
    if (top->rows == 0)
        return;
    run = stack_of(&canvas->tile, top, top->rows);
    if (top->rows == 1)
        draw(canvas, &run);
    else
        for (int layer = 0; layer < rf_sprite_layers(canvas->splat); layer++)
            draw_stack(canvas, top, run, layer);
}

uint64_t rf_splat_share(void)
{
    return sizeof(struct canvas);
}

void rf_splat_highlights(const struct rf_splat *splat, const struct rf_tile_plan *plan, int tx,
                         int ty, void *share, uint16_t *const mean[3])
{
    const struct rf_viewport *view = splat->window.view;
    const int reach = plan->highlight / 256 + 1;
    const int x0 = view->x0 + tx * RF_TILE - reach - RF_HIGHLIGHT_RUN;
    const int y0 = rf_larger(view->y0 + ty * RF_TILE - reach - RF_HIGHLIGHT_STACK, 0);
    const int y1 = rf_smaller(view->y0 + (ty + 1) * RF_TILE + reach, view->photo_height);
    const int x1 = x0 + RF_TILE + 2 * reach + RF_HIGHLIGHT_RUN;
    struct canvas *const canvas = share; /* not all of it is set */

    if (!plan->highlight)
        return;
    canvas->splat = splat;
    canvas->mean = mean;
    canvas->even[0] = canvas->even[1] = canvas->even[2] = canvas->filled = 0;
    rf_visibility_begin(&canvas->tile, splat, plan, tx, ty);
    for (int part = y0 / RF_HIGHLIGHT_ROWS; part * RF_HIGHLIGHT_ROWS < y1; part++) {
        const struct rf_highlight_list *list = &splat->window.highlights->part[part];
        struct rf_highlight *const end = list->run + list->count;
        struct rf_highlight *run = rf_first_run(list->run, end, x0, y0);

        while (run < end && run->y < y1)
            if (run->x < x0)
                run = rf_first_run(run, end, x0, run->y);
            else if (run->x >= x1)
                run = rf_first_run(run, end, x0, run->y + 1);
            else
                draw_highlight(canvas, run++);
    }
    add_rest(canvas);
}
