#include "highlights/sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/kernels.h"
#include "support/compare.h"
#include "tiles/ranges.h"

enum {
    NEARER = 256, /* Q7.8: what hides a lamp is so much nearer */
    MOST_ROWS = 4,
};

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
static void extent(const struct screen *screen, const struct rf_seen *run, double first,
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
                             int tx, int ty, const struct rf_seen *run,
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

/* Rows of pixels that look at one place, to half a pixel: the nearer it is to the run,
 * the more. */
static int rows_alike(double part)
{
    int rows = 1;

    while (rows < MOST_ROWS && 4 * rows * fabs(1 - part) <= 1)
        rows *= 2;
    return rows;
}

/* A look part of the way to the run. No pixel looks farther away than its disc reaches,
 * and half a pixel, nor then farther than the slab is blurred. */
static struct rf_disc_way way_to(const struct rf_seen *run, const struct screen *screen)
{
    const int farthest = run->radius / 2 + RF_LAMP_UNIT,
              most = (abs(screen->slab->centre) + 255) >> 8;
    static const int aside[4] = {14, 6, 2, 10}; /* of a lamp's rows, so that all of it is met */
    struct rf_disc_way way = {.middle = run->y,
                              .rows = rows_alike(screen->part),
                              .aside = aside[run->y & 3],
                              .mirrored = run->y & 1};
    double times, limit;

    while (farthest << way.shift <= INT16_MAX / 4)
        way.shift++;
    times = floor(screen->part * (65536 >> way.shift) + 0.5);
    limit = floor(most * 8388608.0 / (farthest << way.shift));
    way.times = (int16_t)clamp(times, limit < INT16_MAX ? limit : INT16_MAX);
    return way;
}

void rf_start_sights(struct rf_lamp_sights *sights, const struct rf_frame *f,
                     const struct rf_tile_plan *plan, int tx, int ty)
{
    sights->f = f;
    sights->plan = plan;
    sights->tx = tx;
    sights->ty = ty;
    sights->count = 0;
}

static struct rf_lamp_look look_of(const struct rf_tile_plan *plan,
                                   const struct rf_disc_job *job,
                                   const struct rf_seen *run)
{
    struct rf_lamp_look look = {.run = *run, .first = job->first, .end = job->end};
    int most = 0;

    for (;
         look.slabs < plan->slabs && plan->slab[look.slabs].centre < run->blur - NEARER;
         look.slabs++)
        most = rf_larger(most, abs(plan->slab[look.slabs].centre));
    look.part = (float)most / (float)run->radius;
    return look;
}

/* How far from where it leads the other may lead at most, pixels. */
static float apart(const struct rf_lamp_look *look, const struct rf_seen *run)
{
    const struct rf_seen *own = &look->run;
    const int left = abs(run->x - own->x),
              right = abs(run->x + run->count - own->x - own->count);
    const int aside = rf_larger(rf_larger(left, right), abs(run->y - own->y));

    return look->part * ((float)aside + (float)abs(run->blur - own->blur) / 256);
}

static bool serves(const struct rf_lamp_look *look, const struct rf_lamp_look *wanted)
{
    return look->slabs == wanted->slabs && look->first <= wanted->first &&
           look->end >= wanted->end && (look->run.blur < 0) == (wanted->run.blur < 0) &&
           apart(look, &wanted->run) <= 0.25f;
}

static void set_sight(struct rf_lamp_sight *sight, const struct rf_lamp_sights *tile,
                      const struct rf_disc_job *job)
{
    const struct refocus_renderer *r = tile->f->r;
    const struct rf_seen *run = &sight->look.run;
    const int16_t *const blur =
        r->front.blur + tile->ty * RF_TILE * r->stride + tile->tx * RF_TILE;

    sight->hidden = sight->masked = false;
    for (int k = 0; k < sight->look.slabs && !sight->hidden; k++) {
        const struct rf_slab *slab = &tile->plan->slab[k];
        const struct screen screen = {slab, (double)slab->centre / run->blur};
        const enum hidden hidden =
            hidden_by(&screen, tile->f, tile->tx, tile->ty, run, job);
        struct rf_disc_way way;

        sight->hidden = hidden == HIDDEN_WHOLLY;
        if (hidden != HIDDEN_PARTLY)
            continue;
        way = way_to(run, &screen);
        if (!sight->masked)
            memset(sight->visible, 0xff, sizeof sight->visible);
        sight->masked = true;
        r->kernels.hide(sight->visible, blur, r->stride, slab, job, &way);
    }
}

bool rf_sees_lamp(struct rf_lamp_sights *sights, struct rf_disc_job *job,
                  const struct rf_seen *run)
{
    const struct rf_lamp_look wanted = look_of(sights->plan, job, run);
    struct rf_lamp_sight *sight = NULL;

    job->visible = NULL;
    if (!wanted.slabs)
        return true;
    for (int i = 0; i < RF_SIGHTS && i < sights->count && !sight; i++)
        if (serves(&sights->sight[i].look, &wanted))
            sight = &sights->sight[i];
    if (!sight) {
        sight = &sights->sight[sights->count++ % RF_SIGHTS];
        sight->look = wanted;
        set_sight(sight, sights, job);
    }
    if (sight->masked)
        job->visible = sight->visible;
    return !sight->hidden;
}
