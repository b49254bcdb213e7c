#include "highlights/draw.h"

#include <math.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "highlights/highlights.h"
#include "highlights/sight.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    BLURRED = 128, /* Q7.8: a lamp has its light from there on, */
    WHOLLY = 384,  /* and all of it from here on */
    PAIRS = 8192,  /* rows that are hidden in part are drawn by twos from there on */
};

bool rf_draws_lamps(const struct rf_frame *f)
{
    const struct refocus_render_params *p = f->params;
    const struct refocus_aperture *a = f->aperture;

    return rf_is_sweep(f) && p->highlight_gain > 1 && !rf_weighs(p) &&
           (a->shape == RF_SHAPE_DISC || a->chord_sets) && p->cat_eye == 0 && p->fringe == 0;
}

/* Whether the discs of its pixels reach into the tile. */
static bool reaches(const struct rf_seen *run)
{
    const int far = run->radius / 256 + run->rows;
    const int y = run->middle >> 1;

    return run->blur != 0 && run->from - RF_LAMP_UNIT * far < RF_LAMP_UNIT * RF_TILE &&
           run->to + RF_LAMP_UNIT * far > 0 && y - far < RF_TILE && y + far >= 0;
}

/* Of a pixel that shines, Q12: what it lost, and what was taken out. */
static double light_of(const struct rf_frame *f, const struct rf_highlight *lamp, int c)
{
    return lamp->added[c] * (f->params->highlight_gain - 1.0) / 3 + lamp->own[c];
}

/* The light of each pixel of the run that a pixel sees whole, Q14, times 2^(15 - shift)
 * / RF_LAMP_UNIT: all of it, over the disc. */
static bool set_light(struct rf_disc_job *job, const struct rf_frame *f, const struct rf_seen *run)
{
    const struct refocus_aperture *a = f->aperture;
    const double unit = a->shape == RF_SHAPE_DISC ? 3.14159265358979 : a->chord_area;
    const double area = unit * run->radius * run->radius / 65536.0;
    const int blurred = rf_ramp(run->radius, BLURRED, WHOLLY);
    double share;
    bool any = false;

    job->shift = 8;
    for (int length = RF_LAMP_UNIT; length < run->to - run->from; length *= 2)
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
    const int16_t(*const chord)[2] = a->chord[set];
    const double at = (height + 1) * (RF_CHORDS / 2);
    const int row = (int)floor(at);

    for (int k = 0; k < 2; k++)
        ends[k] = row < 0 || row >= RF_CHORDS
                      ? 0
                      : chord[row][k] + (at - row) * (chord[row + 1][k] - chord[row][k]);
}

/* Of a disc rows are as wide to both sides. Behind the focus an iris is seen as it is,
 * and pixels see through it to the other side; before it the other way round. Means, as
 * kernels->half_chords.
 */
static void set_chords(struct rf_disc_job *job, const struct rf_frame *f, const struct rf_seen *run)
{
    const struct refocus_aperture *a = f->aperture;
    const double unit = run->blur * (RF_LAMP_UNIT / (2 * 256.0 * 16384)) / run->rows;

    if (a->shape == RF_SHAPE_DISC) {
        f->r->exec.kernels->half_chords(job->right, run->radius, -run->middle, run->rows);
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

/* Rows that the discs reach, and where they end in them. */
static void set_shape(struct rf_disc_job *job, const struct rf_frame *f, const struct rf_seen *run)
{
    set_chords(job, f, run);
    job->first = 0;
    job->end = RF_TILE;
    while (job->first < RF_TILE && job->left[job->first] == job->right[job->first])
        job->first++;
    while (job->end > job->first && job->left[job->end - 1] == job->right[job->end - 1])
        job->end--;
    job->from = (int16_t)run->from;
    job->to = (int16_t)run->to;
}

/* The means of a tile that lamps are drawn into. */
struct canvas {
    struct rf_lamp_sights sights;
    uint16_t *const *mean;
    int planes;
    int even[3]; /* light that all its pixels get alike, not yet added */
};

/* Whether all pixels see the whole run. */
static bool is_even(const struct rf_disc_job *job)
{
    if (job->visible || job->first > 0 || job->end < RF_TILE)
        return false;
    for (int y = 0; y < RF_TILE; y++)
        if (RF_LAMP_UNIT * (RF_TILE - 1) + job->left[y] > job->from || job->right[y] < job->to)
            return false;
    return true;
}

/* As kernels->draw_disc, which adds nothing below 0, so that the order does not count. */
static void add_disc(struct canvas *canvas, const struct rf_disc_job *job)
{
    const int seen = (job->to - job->from) << job->shift;

    if (!is_even(job)) {
        canvas->sights.f->r->exec.kernels->draw_disc(canvas->mean, job);
        return;
    }
    for (int c = 0; c < job->planes; c++)
        canvas->even[c] =
            rf_smaller(canvas->even[c] + ((seen * job->each[c] + (1 << 14)) >> 15), UINT16_MAX);
}

static void add_even(const struct canvas *canvas)
{
    for (int c = 0; c < canvas->planes; c++)
        for (int i = 0; canvas->even[c] && i < RF_TILE * RF_TILE; i++)
            canvas->mean[c][i] =
                (uint16_t)rf_smaller(canvas->mean[c][i] + canvas->even[c], UINT16_MAX);
}

/* So many as a row of the opening may have. */
static int chord_sets(const struct rf_frame *f)
{
    return f->aperture->shape == RF_SHAPE_DISC ? 1 : f->aperture->chord_sets;
}

/* One set of them, past all slabs but those that are clear. */
static void draw_set(struct canvas *canvas, const struct rf_seen *run, uint64_t clear)
{
    const struct rf_frame *f = canvas->sights.f;
    struct rf_disc_job job = {.planes = canvas->planes};

    if (!reaches(run) || !set_light(&job, f, run))
        return;
    set_shape(&job, f, run);
    if (job.first < job.end && rf_sees_lamp(&canvas->sights, &job, run, clear))
        add_disc(canvas, &job);
}

static void draw(struct canvas *canvas, struct rf_seen run)
{
    for (run.set = 0; run.set < chord_sets(canvas->sights.f); run.set++)
        draw_set(canvas, &run, 0);
}

/* Puts `count` pixels of a row of the window in a run, from (x, y) on. */
static void place(struct rf_seen *run, const struct rf_lamp_sights *tile, int x, int y, int count)
{
    x -= tile->tx * RF_TILE;
    run->from = RF_LAMP_UNIT * x - RF_LAMP_UNIT / 2;
    run->to = run->from + RF_LAMP_UNIT * count;
    run->middle = 2 * (y - tile->ty * RF_TILE);
    run->rows = 1;
    run->turn = y;
    run->set = 0;
}

static void set_blur(struct rf_seen *run, int blur)
{
    run->blur = blur;
    run->radius = abs(blur);
}

/* What of a run is equally far out of focus, from pixel i on, which is in the window:
 * so many pixels. */
static int part_of(struct rf_seen *part, const struct rf_lamp_sights *tile,
                   const struct rf_highlight *lamp, int i)
{
    const struct refocus_renderer *r = tile->f->r;
    const int x = lamp->x - r->view.x0, y = lamp->y - r->view.y0;
    const int16_t *const blur = r->blur.at + y * r->view.stride + x;
    const int first = i, end = rf_smaller(lamp->count, r->view.width - x);
    int least = blur[i], most = blur[i], sum = 0, shining = 0;

    for (; i < end; i++) {
        const int shines = lamp->edges >> i & 1 ? rf_lamp_shine(r, x + i, y) : 256;

        least = rf_smaller(least, blur[i]);
        most = rf_larger(most, blur[i]);
        if (most - least > rf_blurs_alike(least))
            break;
        sum += shines * blur[i];
        shining += shines;
    }
    place(part, tile, x + first, y, i - first);
    set_blur(part, shining ? sum / shining : 0);
    for (int c = 0; c < 3; c++)
        part->light[c] = light_of(tile->f, lamp, c) * shining;
    return i - first;
}

/* Whether any of pixels i to end - 1 of a run does. */
static bool may_reach(const struct rf_lamp_sights *tile, const struct rf_highlight *lamp, int i,
                      int end)
{
    const struct refocus_renderer *r = tile->f->r;
    const int x = lamp->x - r->view.x0, y = lamp->y - r->view.y0;
    const int16_t *const blur = r->blur.at + y * r->view.stride + x;
    struct rf_seen run;
    int most = 0;

    place(&run, tile, x + i, y, end - i);
    for (; i < end; i++)
        most = rf_larger(most, abs(blur[i]));
    set_blur(&run, most);
    return reaches(&run);
}

/* A run that is not, part by part. */
static void draw_parts(struct canvas *canvas, const struct rf_highlight *lamp)
{
    const struct rf_lamp_sights *tile = &canvas->sights;
    const struct refocus_renderer *r = tile->f->r;
    const int x = lamp->x - r->view.x0, first = rf_larger(0, -x),
              end = rf_smaller(lamp->count, r->view.width - x);

    if (!may_reach(tile, lamp, first, end))
        return;
    for (int i = first; i < end;) {
        struct rf_seen part;

        i += part_of(&part, tile, lamp, i);
        draw(canvas, part);
    }
}

/* Rows that are drawn as one: in their middle, as wide as they are in the mean. */
static struct rf_seen stack_of(const struct rf_lamp_sights *tile, const struct rf_highlight *top,
                               int rows)
{
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_highlight *lamp = top;
    int x = 0, count = 0, blur = 0;
    struct rf_seen run = {.light = {0}};

    for (int k = 0; k < rows; k++, lamp += lamp->below) {
        x += lamp->x;
        count += lamp->count;
        blur += lamp->blur;
        for (int c = 0; c < 3; c++)
            run.light[c] += light_of(tile->f, lamp, c) * lamp->shining;
    }
    place(&run, tile, -r->view.x0, top->y - r->view.y0, 0);
    run.from += RF_LAMP_UNIT * x / rows;
    run.to = run.from + RF_LAMP_UNIT * count / rows;
    run.middle += rows - 1;
    run.rows = rows;
    run.turn = top->y / rows;
    set_blur(&run, blur / rows);
    return run;
}

/* Where nothing hides them; else they are drawn in parts, for each to see past that by
 * other ways. */
static void draw_stack(struct canvas *canvas, const struct rf_highlight *top, struct rf_seen run)
{
    const struct rf_frame *f = canvas->sights.f;
    struct rf_disc_job job = {.planes = canvas->planes};
    const int most = run.radius < PAIRS ? 1 : 2;
    const struct rf_highlight *lamp = top;
    enum rf_hidden hidden;
    uint64_t clear = 0;

    if (!reaches(&run) || !set_light(&job, f, &run))
        return;
    set_shape(&job, f, &run);
    hidden = job.first < job.end ? rf_lamp_hidden(&canvas->sights, &job, &run, &clear)
                                 : RF_HIDDEN_WHOLLY;
    if (hidden == RF_HIDDEN_NOWHERE)
        add_disc(canvas, &job);
    for (int k = 0; hidden == RF_HIDDEN_PARTLY && k < top->rows; k += most) {
        const int rows = rf_smaller(most, top->rows - k);
        struct rf_seen part = stack_of(&canvas->sights, lamp, rows);

        part.set = run.set;
        draw_set(canvas, &part, clear);
        for (int i = 0; i < rows; i++)
            lamp += lamp->below;
    }
}

static void draw_lamp(struct canvas *canvas, const struct rf_highlight *lamp)
{
    struct rf_seen run;

    if (lamp->blur == RF_NO_BLUR) {
        draw_parts(canvas, lamp);
        return;
    }
    if (lamp->rows == 0)
        return;
    run = stack_of(&canvas->sights, lamp, lamp->rows);
    if (lamp->rows == 1)
        draw(canvas, run);
    else
        for (; run.set < chord_sets(canvas->sights.f); run.set++)
            draw_stack(canvas, lamp, run);
}

void rf_draw_lamps(const struct rf_frame *f, const struct rf_tile_plan *plan, int tx, int ty,
                   uint16_t *const mean[3], int planes)
{
    const struct refocus_renderer *r = f->r;
    const int reach = plan->lamp / 256 + 1;
    const int x0 = r->view.x0 + tx * RF_TILE - reach - RF_LAMP_RUN;
    const int y0 = rf_larger(r->view.y0 + ty * RF_TILE - reach - RF_LAMP_STACK, 0);
    const int y1 = r->view.y0 + (ty + 1) * RF_TILE + reach;
    const unsigned wide = (unsigned)(RF_TILE + 2 * reach + RF_LAMP_RUN);
    const int parts = rf_lamp_parts(r->photo.height);
    struct canvas canvas; /* large: not all of it set */

    if (!plan->lamp)
        return;
    canvas.mean = mean;
    canvas.planes = planes;
    canvas.even[0] = canvas.even[1] = canvas.even[2] = 0;
    rf_start_sights(&canvas.sights, f, plan, tx, ty);
    for (int part = y0 / RF_LAMP_ROWS; part < parts && part * RF_LAMP_ROWS < y1; part++) {
        const struct rf_highlights *found = &r->photo.highlights[part];
        const struct rf_highlight *lamp = found->lamp, *const end = lamp + found->count;

        while (lamp < end && lamp->y < y0)
            lamp++;
        for (; lamp < end && lamp->y < y1; lamp++)
            if ((unsigned)(lamp->x - x0) < wide)
                draw_lamp(&canvas, lamp);
    }
    add_even(&canvas);
}
