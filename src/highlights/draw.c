#include "highlights/draw.h"

#include <math.h>
#include <stdlib.h>

#include "highlights/clipped.h"
#include "highlights/highlights.h"
#include "kernels/kernels.h"
#include "support/compare.h"
#include "tiles/ranges.h"

enum {
    UNIT = 64,     /* of lengths, in a pixel */
    MASKS = 2 * RF_TILE * RF_TILE,
    NEARER = 256,  /* Q7.8: what hides a lamp is so much nearer */
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

/* A run of a lamp's pixels, as a tile sees it. */
struct seen {
    int x, y, count; /* its first pixel, from the tile's first one on */
    int blur;        /* Q7.8, signed */
    int radius;
    int shining; /* of 256 count */
    const uint16_t *added;
};

/* Whether the discs of its pixels reach into the tile. */
static bool reaches(const struct seen *run)
{
    const int far = run->radius / 256 + 1;

    return run->blur != 0 && run->x - far < RF_TILE && run->x + run->count + far > 0 &&
           run->y - far < RF_TILE && run->y + far >= 0;
}

/* The light of each pixel of the run that a pixel sees whole, Q14, times 2^(15 - shift)
 * / UNIT: all of it, over the disc. */
static bool set_light(struct rf_disc_job *job, const struct rf_frame *f,
                      const struct seen *run)
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
    share *= (double)(1 << (15 - job->shift)) / UNIT / area;
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
                       const struct seen *run)
{
    const struct refocus_aperture *a = f->aperture;
    const double unit = run->blur * (UNIT / (2 * 256.0 * 16384));

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
                      const struct seen *run)
{
    set_chords(job, f, run);
    job->first = 0;
    job->end = RF_TILE;
    while (job->first < RF_TILE && job->left[job->first] == job->right[job->first])
        job->first++;
    while (job->end > job->first && job->left[job->end - 1] == job->right[job->end - 1])
        job->end--;
    job->from = (int16_t)(UNIT * run->x - UNIT / 2);
    job->to = (int16_t)(UNIT * (run->x + run->count) - UNIT / 2);
}

/* A slab that may hide the run: where the tile sees it on its way there. */
struct screen {
    const struct rf_slab *slab;
    double part; /* of the way */
};

static double clamp(double v, double most)
{
    return v < -most ? -most : v > most ? most : v;
}

/* Pixels, from the tile's first one on, among which all lie that rays from pixels
 * `first` to `last` to the run from `from` to `to` see of a screen, in one direction.
 */
static void extent(const struct screen *screen, const struct seen *run, double first,
                   double last, double from, double to, int *least, int *most)
{
    const double far = run->radius / 256.0 + 0.5, part = screen->part;
    double a, b;

    if (part > 1) { /* the farther a pixel, the more it looks to the other side */
        a = first - part * far;
        b = last + part * far;
    } else {
        a = first + part * clamp((part < 0 ? to : from) - first, far);
        b = last + part * clamp((part < 0 ? from : to) - last, far);
    }
    *least = (int)floor(a) - 1;
    *most = (int)floor(b) + 2;
}

enum hidden { HIDDEN_NOWHERE, HIDDEN_PARTLY, HIDDEN_WHOLLY };

/* By the ranges of what may be met, tiles/ranges.h. */
static enum hidden hidden_by(const struct screen *screen, const struct rf_frame *f,
                             int tx, int ty, const struct seen *run,
                             const struct rf_disc_job *job)
{
    const struct refocus_renderer *r = f->r;
    const int low = screen->slab->low, high = low + screen->slab->width;
    const int border = rf_range_border(r->pad), each = RF_TILE / RF_CELL;
    int x0, x1, y0, y1, none = true, all = true;

    extent(screen, run, 0, RF_TILE - 1, run->x - 0.5, run->x + run->count - 0.5, &x0,
           &x1);
    extent(screen, run, job->first, job->end - 1, run->y - 0.25, run->y + 0.25, &y0,
           &y1);
    x0 = rf_larger(((tx * RF_TILE + x0) >> 2), -border);
    y0 = rf_larger(((ty * RF_TILE + y0) >> 2), -border);
    x1 = rf_smaller(((tx * RF_TILE + x1) >> 2), r->tiles_x * each - 1 + border);
    y1 = rf_smaller(((ty * RF_TILE + y1) >> 2), r->tiles_y * each - 1 + border);
    for (int y = y0; y <= y1; y += RF_STRIP / RF_CELL)
        for (int x = x0; x <= x1; x += each) {
            const uint32_t range = r->range[y * r->range_stride + x];
            const int least = rf_range_least(range), most = rf_range_most(range);

            none = none && (most < low || least > high);
            all = all && least >= low && most <= high;
        }
    return none ? HIDDEN_NOWHERE : all ? HIDDEN_WHOLLY : HIDDEN_PARTLY;
}

/* A look part of the way to the run. No pixel looks farther away than its disc reaches, and half a
 * pixel, nor then farther than the slab is blurred. */
static struct rf_disc_way way_to(const struct seen *run, const struct screen *screen)
{
    const int farthest = run->radius / 2 + UNIT, most = (abs(screen->slab->centre) + 255) >> 8;
    struct rf_disc_way way = {.middle = run->y, .mirrored = run->y & 1};
    double times, limit;

    while (farthest << way.shift <= INT16_MAX / 4)
        way.shift++;
    times = floor(screen->part * (65536 >> way.shift) + 0.5);
    limit = floor(most * 8388608.0 / (farthest << way.shift));
    way.times = (int16_t)clamp(times, limit < INT16_MAX ? limit : INT16_MAX);
    return way;
}

/* Sets `visible` where it is needed, and the job's; false: the run is hidden. */
static bool set_visible(struct rf_disc_job *job, uint16_t visible[MASKS],
                        const struct rf_frame *f, const struct rf_tile_plan *plan,
                        int tx, int ty, const struct seen *run)
{
    const struct refocus_renderer *r = f->r;
    const int16_t *const blur = r->front.blur + ty * RF_TILE * r->stride + tx * RF_TILE;

    job->visible = NULL;
    for (int k = 0; k < plan->slabs; k++) {
        const struct rf_slab *slab = &plan->slab[k];
        const struct screen screen = {slab, (double)slab->centre / run->blur};
        struct rf_disc_way way;
        enum hidden hidden;

        if (slab->centre >= run->blur - NEARER)
            break;
        hidden = hidden_by(&screen, f, tx, ty, run, job);
        if (hidden == HIDDEN_WHOLLY)
            return false;
        if (hidden == HIDDEN_NOWHERE)
            continue;
        way = way_to(run, &screen);
        for (int i = 0; !job->visible && i < MASKS; i++)
            visible[i] = 0xffff;
        job->visible = visible;
        r->kernels.hide(visible, blur, r->stride, slab, job, &way);
    }
    return true;
}

static void draw(const struct rf_frame *f, const struct rf_tile_plan *plan, int tx,
                 int ty, const struct seen *run, uint16_t *const mean[3], int planes)
{
    struct rf_disc_job job = {.planes = planes};
    uint16_t visible[MASKS];

    if (!reaches(run) || !set_light(&job, f, run))
        return;
    set_shape(&job, f, run);
    if (job.first < job.end && set_visible(&job, visible, f, plan, tx, ty, run))
        f->r->kernels.draw_disc(mean, &job);
}

/* What of a run is equally far out of focus, from pixel i on, which is in the window. */
static struct seen part_of(const struct refocus_renderer *r, const struct rf_highlight *lamp, int i)
{
    const int x = lamp->x - r->origin_x, y = lamp->y - r->origin_y;
    const int16_t *const blur = r->front.blur + y * r->stride + x;
    const int end = rf_smaller(lamp->count, r->width - x);
    const bool wholly = lamp->shining == 256 * lamp->count;
    int least = blur[i], most = blur[i], sum = 0;
    struct seen part = {.x = x + i, .y = y, .added = lamp->added};

    for (; i < end; i++, part.count++) {
        const int shines = wholly ? 256 : rf_lamp_shine(r, x + i, y);

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
static void draw_parts(const struct rf_frame *f, const struct rf_tile_plan *plan,
                       int tx, int ty, const struct rf_highlight *lamp,
                       uint16_t *const mean[3], int planes)
{
    const struct refocus_renderer *r = f->r;
    const int x = lamp->x - r->origin_x, end = rf_smaller(lamp->count, r->width - x);

    for (int i = rf_larger(0, -x); i < end;) {
        struct seen part = part_of(r, lamp, i);

        i += part.count;
        part.x -= tx * RF_TILE;
        part.y -= ty * RF_TILE;
        draw(f, plan, tx, ty, &part, mean, planes);
    }
}

static void draw_lamp(const struct rf_frame *f, const struct rf_tile_plan *plan, int tx,
                      int ty, const struct rf_highlight *lamp, uint16_t *const mean[3],
                      int planes)
{
    const struct refocus_renderer *r = f->r;
    const struct seen run = {
        .x = lamp->x - r->origin_x - tx * RF_TILE,
        .y = lamp->y - r->origin_y - ty * RF_TILE,
        .count = lamp->count,
        .blur = lamp->blur,
        .radius = abs(lamp->blur),
        .shining = lamp->shining,
        .added = lamp->added,
    };

    if (lamp->blur == RF_NO_BLUR)
        draw_parts(f, plan, tx, ty, lamp, mean, planes);
    else
        draw(f, plan, tx, ty, &run, mean, planes);
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

    if (!plan->lamp)
        return;
    for (int part = y0 / RF_LAMP_ROWS; part < parts && part * RF_LAMP_ROWS < y1;
         part++) {
        const struct rf_highlights *found = &r->photo[r->used].highlights[part];
        const struct rf_highlight *lamp = found->lamp, *const end = lamp + found->count;

        while (lamp < end && lamp->y < y0)
            lamp++;
        for (; lamp < end && lamp->y < y1; lamp++)
            if ((unsigned)(lamp->x - x0) < wide)
                draw_lamp(f, plan, tx, ty, lamp, mean, planes);
    }
}
