/* splat.c: draws highlights as sprites of the aperture into the means of a tile. */
#include "highlights/highlights.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "aperture/aperture.h"
#include "highlights/clipped.h"
#include "highlights/in_window.h"
#include "highlights/visibility.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    BLURRED = 128, /* Q7.8: a splatted highlight begins to have its light at this blur */
    WHOLLY = 384,  /* Q7.8: it has all of its light from this blur on */
    PAIRS = 8192,  /* Q7.8: rows that are hidden in part are drawn by twos from this blur on */
};

/* Where a run is, from the middle of a tile's first pixel on: reach is 128 pixels at the most. */
static_assert(RF_SPLAT_UNIT * (128 + RF_TILE + 2 * RF_HIGHLIGHT_RUN) <= INT16_MAX,
              "the place of a run fits 16 bits");

bool rf_can_splat(const struct rf_settings *params, const struct refocus_aperture *aperture)
{
    return params->highlight_gain > 1 && (rf_aperture_is_disc(aperture) || aperture->chord_sets) &&
           params->cat_eye == 0 && params->fringe == 0;
}

/* Whether the discs of its pixels reach into the tile. */
static bool reaches(const struct rf_splat_run *run)
{
    const int far = run->radius / 256 + run->rows;
    const int y = run->middle >> 1;

    return run->blur != 0 && run->from - RF_SPLAT_UNIT * far < RF_SPLAT_UNIT * RF_TILE &&
           run->to + RF_SPLAT_UNIT * far > 0 && y - far < RF_TILE && y + far >= 0;
}

/* Light of a pixel that is no edge, Q12: what clipping cost, and what was subtracted. */
static double light_of(const struct rf_splat *splat, const struct rf_highlight *run, int c)
{
    return run->boost[c] * (splat->gain - 1.0) / 3 + run->subtracted[c];
}

/* The light of each pixel of the run that a pixel sees whole, Q14, times 2^(15 - shift)
 * / RF_SPLAT_UNIT: all of it, over the disc. */
static bool set_light(struct rf_disc_job *job, const struct rf_splat *splat,
                      const struct rf_splat_run *run)
{
    const struct refocus_aperture *a = splat->aperture;
    const double unit = rf_aperture_is_disc(a) ? 3.14159265358979 : a->chord_area;
    const double area = unit * run->radius * run->radius / 65536.0;
    const int blurred = rf_ramp(run->radius, BLURRED, WHOLLY);
    double share;
    bool any = false;

    static_assert(RF_SPLAT_UNIT << 8 <= 1 << 14, "the length of one pixel, shifted");
    static_assert(RF_SPLAT_UNIT * RF_HIGHLIGHT_RUN << 4 <= 1 << 14, "that of the longest run");
    job->shift = 8;
    for (int length = RF_SPLAT_UNIT; length < run->to - run->from; length *= 2)
        job->shift--;
    share = 4.0 * blurred / 65536 / (run->to - run->from);
    share *= (double)(1 << (15 - job->shift)) / area;
    for (int c = 0; c < job->planes; c++) {
        const double each = run->light[c] * share + 0.5;

        job->each[c] = (int16_t)(each < 32767 ? each : 32767);
        any = any || job->each[c] > 0;
    }
    return any;
}

/* Where a chord begins and ends at a height, in parts of the radius. */
static void chord_at(const struct refocus_aperture *a, int set, double height, double ends[2])
{
    const struct rf_aperture_tables *tables = a->tables;
    const int16_t(*const chord)[2] = tables->chord[set];
    const double at = (height + 1) * (RF_CHORDS / 2);
    const int row = (int)floor(at);

    for (int k = 0; k < 2; k++)
        ends[k] = row < 0 || row >= RF_CHORDS
                      ? 0
                      : chord[row][k] + (at - row) * (chord[row + 1][k] - chord[row][k]);
}

/* Sets the chord of each row. A disc's rows are as wide to both sides. Behind the focus an iris is
 * seen as it is, and pixels see through it to the other side; before it the other way round. Chords
 * are means, as those of kernels->half_chords. */
static void set_chords(struct rf_disc_job *job, const struct rf_splat *splat,
                       const struct rf_splat_run *run)
{
    const struct refocus_aperture *a = splat->aperture;
    const double unit = run->blur * (RF_SPLAT_UNIT / (2 * 256.0 * 16384)) / run->rows;

    if (rf_aperture_is_disc(a)) {
        splat->exec->kernels->half_chords(job->right, run->radius, -run->middle, run->rows);
        for (int y = 0; y < RF_TILE; y++)
            job->left[y] = (int16_t)-job->right[y];
        return;
    }
    for (int y = 0; y < RF_TILE; y++) {
        double first = 0, last = 0;

        for (int k = 0; k < 2 * run->rows; k++) {
            const double away = y + (k - run->rows - run->middle) * 0.5 + 0.25;
            double ends[2];

            chord_at(a, run->set, 256 * away / run->blur, ends);
            first -= unit * ends[1];
            last -= unit * ends[0];
        }
        job->left[y] = (int16_t)floor((first < last ? first : last) + 0.5);
        job->right[y] = (int16_t)floor((first < last ? last : first) + 0.5);
    }
}

/* Sets the rows that the discs reach, and where they end in them. */
static void set_shape(struct rf_disc_job *job, const struct rf_splat *splat,
                      const struct rf_splat_run *run)
{
    set_chords(job, splat, run);
    job->first = 0;
    job->end = RF_TILE;
    while (job->first < RF_TILE && job->left[job->first] == job->right[job->first])
        job->first++;
    while (job->end > job->first && job->left[job->end - 1] == job->right[job->end - 1])
        job->end--;
    job->from = (int16_t)run->from;
    job->to = (int16_t)run->to;
}

/* The means of a tile that highlights are drawn into. */
struct canvas {
    struct rf_visibility tile;
    const struct rf_splat *splat;
    uint16_t *const *mean;
    int even[3]; /* light that all its pixels get alike, not yet added */
};

/* Whether all pixels see the whole run. */
static bool is_even(const struct rf_disc_job *job)
{
    if (job->visible || job->first > 0 || job->end < RF_TILE)
        return false;
    for (int y = 0; y < RF_TILE; y++)
        if (RF_SPLAT_UNIT * (RF_TILE - 1) + job->left[y] > job->from || job->right[y] < job->to)
            return false;
    return true;
}

/* Adds a disc as kernels->draw_disc does, which adds nothing below 0, so that the order does not
 * count. */
static void add_disc(struct canvas *canvas, const struct rf_disc_job *job)
{
    const int seen = (job->to - job->from) << job->shift;

    static_assert((1 << 14) * INT16_MAX + (1 << 14) <= INT32_MAX, "of light and what is seen");
    if (!is_even(job)) {
        canvas->splat->exec->kernels->draw_disc(canvas->mean, job);
        return;
    }
    for (int c = 0; c < job->planes; c++)
        canvas->even[c] =
            rf_smaller(canvas->even[c] + ((seen * job->each[c] + (1 << 14)) >> 15), UINT16_MAX);
}

static void add_even(const struct canvas *canvas)
{
    for (int c = 0; c < canvas->splat->window.channels; c++)
        for (int i = 0; canvas->even[c] && i < RF_TILE * RF_TILE; i++)
            canvas->mean[c][i] =
                (uint16_t)rf_smaller(canvas->mean[c][i] + canvas->even[c], UINT16_MAX);
}

/* How many chords a row of the aperture may have. */
static int chord_sets(const struct refocus_aperture *a)
{
    return rf_aperture_is_disc(a) ? 1 : a->chord_sets;
}

/* Draws a run through one set of chords, past all slabs but those that are clear. */
static void draw_set(struct canvas *canvas, const struct rf_splat_run *run, uint64_t clear)
{
    const struct rf_splat *splat = canvas->splat;
    struct rf_disc_job job = {.planes = splat->window.channels};

    if (!reaches(run) || !set_light(&job, splat, run))
        return;
    set_shape(&job, splat, run);
    if (job.first < job.end && rf_run_visible(&canvas->tile, &job, run, clear))
        add_disc(canvas, &job);
}

static void draw(struct canvas *canvas, struct rf_splat_run run)
{
    for (run.set = 0; run.set < chord_sets(canvas->splat->aperture); run.set++)
        draw_set(canvas, &run, 0);
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
    run->set = 0;
}

static void set_blur(struct rf_splat_run *run, int blur)
{
    run->blur = blur;
    run->radius = abs(blur);
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
    int least = blur[i], most = blur[i], sum = 0, weight = 0;

    for (; i < end; i++) {
        const int own = rf_is_edge(run, i) ? rf_edge_weight(w, x + i, y) : 256;

        least = rf_smaller(least, blur[i]);
        most = rf_larger(most, blur[i]);
        if (most - least > rf_alike_within(least))
            break;
        sum += own * blur[i];
        weight += own;
    }
    place(part, tile, x + first, y, i - first);
    set_blur(part, weight ? sum / weight : 0);
    for (int c = 0; c < 3; c++)
        part->light[c] = light_of(tile->splat, run, c) * weight;
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
    set_blur(&part, most);
    return reaches(&part);
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
        draw(canvas, part);
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
            run.light[c] += light_of(tile->splat, row, c) * row->weight;
    }
    place(&run, tile, -view->x0, top->y - view->y0, 0);
    run.from += RF_SPLAT_UNIT * x / rows;
    run.to = run.from + RF_SPLAT_UNIT * count / rows;
    run.middle += rows - 1;
    run.rows = rows;
    run.turn = top->y / rows;
    set_blur(&run, blur / rows);
    return run;
}

/* Draws them as one where nothing hides them; else in parts, for each to see past that by other
 * ways. */
static void draw_stack(struct canvas *canvas, const struct rf_highlight *top,
                       struct rf_splat_run run)
{
    const struct rf_splat *splat = canvas->splat;
    struct rf_disc_job job = {.planes = splat->window.channels};
    const int most = run.radius < PAIRS ? 1 : 2;
    const struct rf_highlight *row = top;
    enum rf_hidden hidden;
    uint64_t clear = 0;

    if (!reaches(&run) || !set_light(&job, splat, &run))
        return;
    set_shape(&job, splat, &run);
    hidden =
        job.first < job.end ? rf_run_hidden(&canvas->tile, &job, &run, &clear) : RF_HIDDEN_WHOLLY;
    if (hidden == RF_HIDDEN_NOWHERE)
        add_disc(canvas, &job);
    for (int k = 0; hidden == RF_HIDDEN_PARTLY && k < top->rows; k += most) {
        const int rows = rf_smaller(most, top->rows - k);
        struct rf_splat_run part = stack_of(&canvas->tile, row, rows);

        part.set = run.set;
        draw_set(canvas, &part, clear);
        for (int i = 0; i < rows; i++)
            row += row->below;
    }
}

static void draw_highlight(struct canvas *canvas, const struct rf_highlight *top)
{
    struct rf_splat_run run;

    if (top->blur == RF_NO_BLUR) {
        draw_parts(canvas, top);
        return;
    }
    if (top->rows == 0)
        return;
    run = stack_of(&canvas->tile, top, top->rows);
    if (top->rows == 1)
        draw(canvas, run);
    else
        for (; run.set < chord_sets(canvas->splat->aperture); run.set++)
            draw_stack(canvas, top, run);
}

void rf_splat_highlights(const struct rf_splat *splat, const struct rf_tile_plan *plan, int tx,
                         int ty, uint16_t *const mean[3])
{
    const struct rf_viewport *view = splat->window.view;
    const int reach = plan->highlight / 256 + 1;
    const int x0 = view->x0 + tx * RF_TILE - reach - RF_HIGHLIGHT_RUN;
    const int y0 = rf_larger(view->y0 + ty * RF_TILE - reach - RF_HIGHLIGHT_STACK, 0);
    const int y1 = rf_smaller(view->y0 + (ty + 1) * RF_TILE + reach, view->photo_height);
    const unsigned wide = (unsigned)(RF_TILE + 2 * reach + RF_HIGHLIGHT_RUN);
    struct canvas canvas; /* large: not all of it set */

    if (!plan->highlight)
        return;
    canvas.splat = splat;
    canvas.mean = mean;
    canvas.even[0] = canvas.even[1] = canvas.even[2] = 0;
    rf_visibility_begin(&canvas.tile, splat, plan, tx, ty);
    for (int part = y0 / RF_HIGHLIGHT_ROWS; part * RF_HIGHLIGHT_ROWS < y1; part++) {
        const struct rf_highlight_list *list = &splat->window.highlights->part[part];
        const struct rf_highlight *run = list->run, *const end = run + list->count;

        while (run < end && run->y < y0)
            run++;
        for (; run < end && run->y < y1; run++)
            if ((unsigned)(run->x - x0) < wide)
                draw_highlight(&canvas, run);
    }
    add_even(&canvas);
}
