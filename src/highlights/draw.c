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
};

bool rf_draws_lamps(const struct rf_frame *f)
{
    const struct refocus_render_params *p = f->params;
    const struct refocus_aperture *a = f->aperture;

    return rf_is_sweep(f) && p->highlight_gain > 1 && !rf_weighs(p) &&
           (a->shape == RF_SHAPE_DISC || rf_aperture_has_chords(a)) &&
           p->cat_eye == 0 && p->fringe == 0;
}

/* Whether the discs of its pixels reach into the tile. */
static bool reaches(const struct rf_seen *run)
{
    const int far = run->radius / 256 + 1;

    return run->blur != 0 && run->x - far < RF_TILE && run->x + run->count + far > 0 &&
           run->y - far < RF_TILE && run->y + far >= 0;
}

/* The light of each pixel of the run that a pixel sees whole, Q14, times 2^(15 - shift)
 * / RF_LAMP_UNIT: all of it, over the disc. */
static bool set_light(struct rf_disc_job *job, const struct rf_frame *f,
                      const struct rf_seen *run)
{
    const struct refocus_aperture *a = f->aperture;
    const double unit = a->shape == RF_SHAPE_DISC ? 3.14159265358979 : a->chord_area;
    const double area = unit * run->radius * run->radius / 65536.0;
    const double gain = f->params->highlight_gain;
    const int blurred = rf_ramp(run->radius, BLURRED, WHOLLY);
    double share;
    bool any = false;

    job->shift = 8;
    for (int n = 1; n < run->count; n *= 2)
        job->shift--;
    share = 4 * (gain - 1) / 3 * blurred / 256 * run->shining / (256 * run->count);
    share *= (double)(1 << (15 - job->shift)) / RF_LAMP_UNIT / area;
    for (int c = 0; c < job->planes; c++) {
        const double each = run->added[c] * share + 0.5;

        job->each[c] = (int16_t)(each < 32767 ? each : 32767);
        any = any || job->each[c] > 0;
    }
    return any;
}

/* Where a chord begins and ends at a height, in parts of the radius. */
static void chord_at(const struct refocus_aperture *a, double height, double ends[2])
{
    const double at = (height + 1) * (RF_CHORDS / 2);
    const int row = (int)floor(at);

    for (int k = 0; k < 2; k++)
        ends[k] = row < 0 || row >= RF_CHORDS
                      ? 0
                      : a->chord[row][k] +
                            (at - row) * (a->chord[row + 1][k] - a->chord[row][k]);
}

/* Of a disc rows are as wide to both sides. Behind the focus an iris is seen as it is,
 * and pixels see through it to the other side; before it the other way round. Means of
 * a quarter of a pixel above and below the middle of the row, as kernels->half_chords.
 */
static void set_chords(struct rf_disc_job *job, const struct rf_frame *f,
                       const struct rf_seen *run)
{
    const struct refocus_aperture *a = f->aperture;
    const double unit = run->blur * (RF_LAMP_UNIT / (2 * 256.0 * 16384));

    if (a->shape == RF_SHAPE_DISC) {
        f->r->kernels.half_chords(job->right, run->radius, -run->y);
        for (int y = 0; y < RF_TILE; y++)
            job->left[y] = (int16_t)-job->right[y];
        return;
    }
    for (int y = 0; y < RF_TILE; y++) {
        const double height = 256.0 * (y - run->y) / run->blur,
                     quarter = 64.0 / run->blur;
        double above[2], below[2], first, last;

        chord_at(a, height - quarter, above);
        chord_at(a, height + quarter, below);
        first = -unit * (above[1] + below[1]);
        last = -unit * (above[0] + below[0]);
        job->left[y] = (int16_t)floor((first < last ? first : last) + 0.5);
        job->right[y] = (int16_t)floor((first < last ? last : first) + 0.5);
    }
}

/* Rows that the discs reach, and where they end in them. */
static void set_shape(struct rf_disc_job *job, const struct rf_frame *f,
                      const struct rf_seen *run)
{
    set_chords(job, f, run);
    job->first = 0;
    job->end = RF_TILE;
    while (job->first < RF_TILE && job->left[job->first] == job->right[job->first])
        job->first++;
    while (job->end > job->first && job->left[job->end - 1] == job->right[job->end - 1])
        job->end--;
    job->from = (int16_t)(RF_LAMP_UNIT * run->x - RF_LAMP_UNIT / 2);
    job->to = (int16_t)(RF_LAMP_UNIT * (run->x + run->count) - RF_LAMP_UNIT / 2);
}

/* The means of a tile that lamps are drawn into. */
struct canvas {
    struct rf_lamp_sights sights;
    uint16_t *const *mean;
    int planes;
};

static void draw(struct canvas *canvas, const struct rf_seen *run)
{
    const struct rf_frame *f = canvas->sights.f;
    struct rf_disc_job job = {.planes = canvas->planes};

    if (!reaches(run) || !set_light(&job, f, run))
        return;
    set_shape(&job, f, run);
    if (job.first < job.end && rf_sees_lamp(&canvas->sights, &job, run))
        f->r->kernels.draw_disc(canvas->mean, &job);
}

/* What of a run is equally far out of focus, from pixel i on, which is in the window.
 */
static struct rf_seen part_of(const struct refocus_renderer *r,
                              const struct rf_highlight *lamp, int i)
{
    const int x = lamp->x - r->origin_x, y = lamp->y - r->origin_y;
    const int16_t *const blur = r->front.blur + y * r->stride + x;
    const int end = rf_smaller(lamp->count, r->width - x);
    int least = blur[i], most = blur[i], sum = 0;
    struct rf_seen part = {.x = x + i, .y = y, .added = lamp->added};

    for (; i < end; i++, part.count++) {
        const int shines = lamp->edges >> i & 1 ? rf_lamp_shine(r, x + i, y) : 256;

        least = rf_smaller(least, blur[i]);
        most = rf_larger(most, blur[i]);
        if (most - least > RF_BLURS_ALIKE)
            break;
        sum += shines * blur[i];
        part.shining += shines;
    }
    part.blur = part.shining ? sum / part.shining : 0;
    part.radius = abs(part.blur);
    return part;
}

/* A run that is not, part by part. */
static void draw_parts(struct canvas *canvas, const struct rf_highlight *lamp)
{
    const struct rf_lamp_sights *tile = &canvas->sights;
    const struct refocus_renderer *r = tile->f->r;
    const int x = lamp->x - r->origin_x, end = rf_smaller(lamp->count, r->width - x);

    for (int i = rf_larger(0, -x); i < end;) {
        struct rf_seen part = part_of(r, lamp, i);

        i += part.count;
        part.x -= tile->tx * RF_TILE;
        part.y -= tile->ty * RF_TILE;
        draw(canvas, &part);
    }
}

static void draw_lamp(struct canvas *canvas, const struct rf_highlight *lamp)
{
    const struct rf_lamp_sights *tile = &canvas->sights;
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_seen run = {
        .x = lamp->x - r->origin_x - tile->tx * RF_TILE,
        .y = lamp->y - r->origin_y - tile->ty * RF_TILE,
        .count = lamp->count,
        .blur = lamp->blur,
        .radius = abs(lamp->blur),
        .shining = lamp->shining,
        .added = lamp->added,
    };

    if (lamp->blur == RF_NO_BLUR)
        draw_parts(canvas, lamp);
    else
        draw(canvas, &run);
}

void rf_draw_lamps(const struct rf_frame *f, const struct rf_tile_plan *plan, int tx,
                   int ty, uint16_t *const mean[3], int planes)
{
    const struct refocus_renderer *r = f->r;
    const int reach = plan->lamp / 256 + 1;
    const int x0 = r->origin_x + tx * RF_TILE - reach - RF_LAMP_RUN;
    const int y0 = rf_larger(r->origin_y + ty * RF_TILE - reach, 0);
    const int y1 = r->origin_y + (ty + 1) * RF_TILE + reach;
    const unsigned wide = (unsigned)(RF_TILE + 2 * reach + RF_LAMP_RUN);
    const int parts = rf_lamp_parts(r->photo[r->used].height);
    struct canvas canvas;

    if (!plan->lamp)
        return;
    canvas.mean = mean;
    canvas.planes = planes;
    rf_start_sights(&canvas.sights, f, plan, tx, ty);
    for (int part = y0 / RF_LAMP_ROWS; part < parts && part * RF_LAMP_ROWS < y1;
         part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];
        const struct rf_highlight *lamp = found->lamp, *const end = lamp + found->count;

        while (lamp < end && lamp->y < y0)
            lamp++;
        for (; lamp < end && lamp->y < y1; lamp++)
            if ((unsigned)(lamp->x - x0) < wide)
                draw_lamp(&canvas, lamp);
    }
}
