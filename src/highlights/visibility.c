/* visibility.c: finds which part of a splatted highlight each pixel of a tile sees, and which part
 * nearer surfaces occlude.
 *
 * A ray from pixel p to a pixel q of a highlight passes a surface of blur s, if there is one, at
 * the part s / s(q) of its way, by eq. 4. So for each slab that is nearer than the highlight the
 * blur at that place is looked up, and if it lies in the slab, it occludes q: the test that rays
 * make.
 *
 * An example: a highlight of blur s(q) = 20 is 10 pixels to the right of p, and one slab holds the
 * blurs 7 to 9, with the centre 8. The ray passes the slab at 8 / 20 of its way, 4 pixels to the
 * right. If the blur there is 8.5, a surface of the slab occludes the highlight. If it is 20, only
 * the highlight's own surface is there, and p sees it. A surface of blur -3, before the focus, is
 * looked for by another slab where the ray passes it: at -3 / 20 of the way, 1.5 pixels to the
 * left.
 */
#include "highlights/visibility.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/kernels.h"
#include "support/compare.h"
#include "tiles/ranges.h"

enum {
    NEARER = 256, /* Q7.8: a surface has to be nearer by so much to occlude a highlight, or more */
    LARGE = 32,   /* pixels: larger regions are not searched for an occluder */
    MOST_ROWS = 4,
    LEAST_RADIUS = 2048, /* Q7.8: rows that look at one place are an eighth of a pixel apart, those
                            of larger discs more */
    TOGETHER = 448,      /* Q7.8: slabs that are no wider are looked at as one */
};
static_assert(TOGETHER <= 480, "slabs are told apart modulo 2^16 (kernels/rays.h)");

/* The part of a slab that may occlude the run, and where on the way to the run it is. */
struct occluder {
    struct rf_slab slab;
    double part; /* how far along the way, 0 to 1 */
};

/* Leaves out of a slab the run itself and surfaces that are about as near. */
static struct occluder occluder_of(const struct rf_visibility *tile, const struct rf_slab *slab,
                                   const struct rf_splat_run *run)
{
    const int unit = tile->splat->window.blur.unit;
    const int most = ((run->blur - tile->nearer) >> unit) - slab->low;
    struct occluder occluder = {*slab, 0};

    if (most < slab->width) {
        occluder.slab.width = (uint16_t)most;
        occluder.slab.centre = (int16_t)(slab->low + (most + 1) / 2);
    }
    occluder.part = (double)rf_in_pixels(occluder.slab.centre, unit) / run->blur;
    if (occluder.part < 0)
        occluder.part *= run->across;
    return occluder;
}

static double clamp(double v, double most)
{
    return v < -most ? -most : v > most ? most : v;
}

static int round_down(double v)
{
    const int i = (int)v;

    return i - (i > v);
}

/* Finds where rays from pixels `first` to `last` to the run, which goes from `from` to `to`, pass
 * an occluder: from pixel *least to *most, along one axis. */
static void extent(const struct occluder *occluder, const struct rf_splat_run *run, double first,
                   double last, double from, double to, int *least, int *most)
{
    const double far = run->radius / 256.0 + run->rows * 0.5, part = occluder->part;
    double a, b;

    if (part > 1) { /* rays come from the other side of the run */
        a = first - part * far;
        b = last + part * far;
    } else {
        a = first + part * clamp((part < 0 ? to : from) - first, far);
        b = last + part * clamp((part < 0 ? from : to) - last, far);
    }
    *least = round_down(a) - 1;
    *most = round_down(b) + 2;
}

/* How far beyond the tile blurs are looked up at most, in pixels. The frame alone decides, so that
 * this does not depend on the tile. */
static int farthest_look(const struct rf_splat *splat)
{
    return ((splat->largest_radius + 254) >> 8) + 2;
}

/* Where in the window rays from the tile to the run pass the occluder; x1 and y1 are part of it. */
static struct rf_rect region_of(const struct occluder *occluder, const struct rf_visibility *tile,
                                const struct rf_splat_run *run, const struct rf_disc_job *job)
{
    const double middle = run->middle * 0.5, apart = run->rows * 0.5 - 0.25;
    const int x = tile->tx * RF_TILE, y = tile->ty * RF_TILE, far = farthest_look(tile->splat),
              most = RF_TILE - 1 + far;
    struct rf_rect at;

    extent(occluder, run, 0, RF_TILE - 1, run->from / (double)RF_SPLAT_UNIT,
           run->to / (double)RF_SPLAT_UNIT, &at.x0, &at.x1);
    extent(occluder, run, job->first, job->end - 1, middle - apart, middle + apart, &at.y0, &at.y1);
    return (struct rf_rect){x + rf_larger(at.x0, -far), y + rf_larger(at.y0, -far),
                            x + rf_smaller(at.x1, most), y + rf_smaller(at.y1, most)};
}

/* Tells from the ranges of blur alone (tiles/ranges.h) how much of a region is in a slab. */
static enum rf_hidden hidden_in_ranges(const struct rf_splat *splat, const struct rf_slab *slab,
                                       struct rf_rect at)
{
    const struct rf_viewport *view = splat->window.view;
    const int low = slab->low, high = low + slab->width;
    const int border = rf_range_border(view->pad), each = RF_TILE / RF_CELL;
    const int first = rf_larger(at.x0 >> 2, -border),
              end = rf_smaller(at.x1 >> 2, view->tiles_x * each - 1 + border),
              last = rf_smaller(at.y1 >> 2, view->tiles_y * each - 1 + border);
    bool none = true, all = true;

    for (int y = rf_larger(at.y0 >> 2, -border); y <= last && (none || all);
         y += RF_STRIP / RF_CELL)
        for (int x = first; x <= end; x += each) {
            const uint32_t range = splat->range.at[y * splat->range.stride + x];
            const int least = rf_range_least(range), most = rf_range_most(range);

            none = none && (most < low || least > high);
            all = all && least >= low && most <= high;
        }
    return all ? RF_HIDDEN_WHOLLY : none ? RF_HIDDEN_NOWHERE : RF_HIDDEN_PARTLY;
}

/* Whether any pixel of a region, or beside a narrow one, is in a slab. A large region is not
 * searched, as some pixel of it may be. */
static bool may_occlude(const struct rf_splat *splat, const struct rf_slab *slab, struct rf_rect at,
                        int far)
{
    const struct rf_blur_q8 *blur = &splat->window.blur;
    const int wide = rf_larger(at.x1 - at.x0 + 1, RF_TILE), high = at.y1 - at.y0 + 1;
    const int x = rf_larger(at.x1 - wide + 1, -far);

    return wide > LARGE || high > LARGE ||
           splat->exec->kernels->any_in_slab(blur->at + at.y0 * blur->stride + x, blur->stride,
                                             wide, high, slab);
}

static enum rf_hidden hidden_by(const struct occluder *occluder, const struct rf_visibility *tile,
                                const struct rf_splat_run *run, const struct rf_disc_job *job)
{
    const struct rf_rect at = region_of(occluder, tile, run, job);
    const enum rf_hidden hidden = hidden_in_ranges(tile->splat, &occluder->slab, at);

    return hidden == RF_HIDDEN_PARTLY &&
                   !may_occlude(tile->splat, &occluder->slab, at, farthest_look(tile->splat))
               ? RF_HIDDEN_NOWHERE
               : hidden;
}

/* How many rows of pixels share one row of places where they look for an occluder: the nearer this
 * is to the run, and the larger the disc, the more. */
static int rows_alike(double part, int radius)
{
    const double away = rf_larger(radius, LEAST_RADIUS) / (64 * 256.0);
    int rows = 1;

    while (rows < MOST_ROWS && (2 * rows - 1) * fabs(1 - part) <= away)
        rows *= 2;
    return rows;
}

/* Where pixels look for an occluder on the way to the run. None looks farther away than its disc
 * reaches and half its rows, nor farther than `far`. */
static struct rf_disc_way way_to(const struct rf_splat_run *run, const struct occluder *occluder,
                                 int far, int unit, int blur_unit)
{
    const int farthest = (run->radius / 2 + RF_SPLAT_UNIT * run->rows) >> unit;
    const double part = fabs(occluder->part);
    static_assert(224 * 256 / 2 + RF_SPLAT_UNIT * RF_HIGHLIGHT_STACK <= INT16_MAX,
                  "the way of a pixel fits 16 bits");
    static const int aside[4] = {14, 6, 2, 10}; /* so that the ways lead to all of a highlight */
    struct rf_disc_way way = {.rows = rows_alike(occluder->part, run->radius),
                              .most = far,
                              .middle = run->middle,
                              .aside = aside[run->turn & 3],
                              .mirrored = run->turn & 1};
    double whole = 1 << (16 + unit), times, limit; /* all of the way */

    while (farthest << way.shift <= INT16_MAX / 4)
        way.shift++;
    /* The kernel is quickest without a unit, which places within 126 pixels do not need. */
    for (; way.unit < blur_unit && (part * whole > (double)INT16_MAX * (1 << way.shift) ||
                                    part * run->radius > 256 * 126 << way.unit);
         way.unit++)
        whole /= 2;
    /* No pixel is as far away as the farthest. So there is a bit for a slab that is more than half
     * of the way to a run that is out of focus by 64 pixels and more. */
    if (part * whole > (double)INT16_MAX * (1 << way.shift) && farthest << way.shift <= 1 << 14)
        way.shift++;
    times = floor(occluder->part * whole / (1 << way.shift) + 0.5);
    limit = floor(far * (double)(1 << (23 - way.unit)) / (farthest << way.shift));
    way.times = (int16_t)clamp(times, limit < INT16_MAX ? limit : INT16_MAX);
    return way;
}

/* Merges a slab with the last one, if both are narrow enough together; returns whether. */
static bool merges(struct rf_visibility *tile, const struct rf_slab *next, int unit)
{
    struct rf_slab *last = tile->slab + tile->slabs - 1;
    int width;

    if (!tile->slabs || last->centre == 0 || next->centre == 0)
        return false;
    width = next->low + next->width - last->low;
    if (width > TOGETHER >> unit || (last->low < 0) != (next->low < 0))
        return false;
    last->width = (uint16_t)width;
    last->centre = (int16_t)(last->low + (width + 1) / 2);
    return true;
}

void rf_visibility_begin(struct rf_visibility *tile, const struct rf_splat *splat,
                         const struct rf_tile_plan *plan, int tx, int ty)
{
    tile->splat = splat;
    tile->tx = tx;
    tile->ty = ty;
    tile->count = 0;
    tile->slabs = 0;
    /* Where a surface is Gaussian noise, one pixel in 250 is nearer than another by 3.75 standard
     * deviations. */
    tile->nearer = rf_larger(NEARER, plan->noise + plan->noise / 2);
    for (int k = 0; k < plan->slabs; k++) {
        const bool closes_crack = k > 0 && plan->slab[k].low < plan->slab[k - 1].low;

        if (!closes_crack && !merges(tile, &plan->slab[k], splat->window.blur.unit))
            tile->slab[tile->slabs++] = plan->slab[k];
    }
}

/* How far apart, in pixels, rays to two runs pass a slab at most. */
static float apart(const struct rf_splat_run *one, const struct rf_splat_run *other, int centre)
{
    const int right = rf_larger(abs(one->from - other->from), abs(one->to - other->to));
    const int down = RF_SPLAT_UNIT / 2 * abs(one->middle - other->middle);
    const int blurs = abs(one->blur - other->blur) * RF_SPLAT_UNIT / 256;
    const int away = rf_larger(right, down) + blurs;

    return (float)abs(centre) * (float)away / (float)(RF_SPLAT_UNIT * one->radius);
}

static bool can_reuse(const struct rf_look_at *look, const struct rf_look_at *wanted, int centre)
{
    return look->slab == wanted->slab && look->run.layer == wanted->run.layer &&
           look->first <= wanted->first && look->end >= wanted->end &&
           (look->run.blur < 0) == (wanted->run.blur < 0) &&
           apart(&look->run, &wanted->run, centre) <= 0.25f;
}

/* Tells from the masks of rows first to end - 1 how much is hidden from their pixels. */
static enum rf_hidden hidden_in(const uint16_t *visible, int first, int end)
{
    uint16_t any = 0, all = 0xffff;

    for (int i = RF_TILE * first; i < RF_TILE * end; i++) {
        any |= visible[i] | visible[RF_TILE * RF_TILE + i];
        all &= visible[i] & visible[RF_TILE * RF_TILE + i];
    }
    return all ? RF_HIDDEN_NOWHERE : any ? RF_HIDDEN_PARTLY : RF_HIDDEN_WHOLLY;
}

static void set_occlusion(struct rf_occlusion *occlusion, const struct rf_visibility *tile,
                          const struct rf_disc_job *job)
{
    const struct rf_blur_q8 *plane = &tile->splat->window.blur;
    const struct rf_splat_run *run = &occlusion->look.run;
    const struct rf_slab *slab = &tile->slab[occlusion->look.slab];
    const struct occluder occluder = occluder_of(tile, slab, run);
    const int16_t *const blur = plane->at + tile->ty * RF_TILE * plane->stride + tile->tx * RF_TILE;
    struct rf_disc_way way;

    occlusion->hidden = hidden_by(&occluder, tile, run, job);
    if (occlusion->hidden != RF_HIDDEN_PARTLY)
        return;
    way = way_to(run, &occluder, farthest_look(tile->splat), job->unit, plane->unit);
    tile->splat->exec->kernels->occlude_disc(occlusion->visible, blur, plane->stride,
                                             &occluder.slab, job, &way);
    occlusion->hidden = hidden_in(occlusion->visible, job->first, job->end);
}

static const struct rf_occlusion *occlusion_of(struct rf_visibility *tile,
                                               const struct rf_disc_job *job,
                                               const struct rf_splat_run *run, int slab)
{
    const struct rf_look_at wanted = {*run, job->first, job->end, slab};
    const int unit = tile->splat->window.blur.unit;
    const int centre = rf_in_pixels(tile->slab[slab].centre, unit);
    /* The result for a slab farther out serves no other row. */
    const bool kept = 4 * abs(centre) <= run->radius;
    struct rf_occlusion *occlusion = &tile->other;

    for (int i = 0; kept && i < RF_KEPT_OCCLUSIONS && i < tile->count; i++)
        if (can_reuse(&tile->occlusion[i].look, &wanted, centre))
            return &tile->occlusion[i];
    if (kept)
        occlusion = &tile->occlusion[tile->count++ % RF_KEPT_OCCLUSIONS];
    occlusion->look = wanted;
    set_occlusion(occlusion, tile, job);
    return occlusion;
}

/* Clears the visible pixels from which a further slab occludes the run. */
static void subtract_occluded(struct rf_visibility *tile, struct rf_disc_job *job,
                              const struct rf_occlusion *occlusion)
{
    for (int side = 0; side < 2; side++) {
        const int first = RF_TILE * (RF_TILE * side + job->first);
        const int count = RF_TILE * (job->end - job->first);
        const uint16_t *const further = occlusion->visible + first;
        uint16_t *const visible = tile->visible + first;

        if (!job->visible)
            memcpy(visible, further, (size_t)count * sizeof *visible);
        else
            for (int i = 0; i < count; i++)
                visible[i] &= further[i];
    }
    job->visible = tile->visible;
}

static bool is_nearer(const struct rf_visibility *tile, int k, const struct rf_splat_run *run)
{
    return rf_in_pixels(tile->slab[k].low, tile->splat->window.blur.unit) <=
           run->blur - tile->nearer;
}

enum rf_hidden rf_run_hidden(const struct rf_visibility *tile, const struct rf_disc_job *job,
                             const struct rf_splat_run *run, uint64_t *clear)
{
    enum rf_hidden hidden = RF_HIDDEN_NOWHERE;

    *clear = 0;
    for (int k = 0; k < tile->slabs && is_nearer(tile, k, run); k++) {
        const struct occluder occluder = occluder_of(tile, &tile->slab[k], run);
        const enum rf_hidden by = hidden_by(&occluder, tile, run, job);

        if (by == RF_HIDDEN_WHOLLY)
            return by;
        if (by == RF_HIDDEN_PARTLY)
            hidden = by;
        else if (k < 64)
            *clear |= UINT64_C(1) << k;
    }
    return hidden;
}

bool rf_run_visible(struct rf_visibility *tile, struct rf_disc_job *job,
                    const struct rf_splat_run *run, uint64_t clear)
{
    job->visible = NULL;
    for (int k = 0; k < tile->slabs && is_nearer(tile, k, run); k++) {
        const struct rf_occlusion *occlusion;

        if (k < 64 && clear >> k & 1)
            continue;
        occlusion = occlusion_of(tile, job, run, k);
        if (occlusion->hidden == RF_HIDDEN_WHOLLY)
            return false;
        if (occlusion->hidden == RF_HIDDEN_PARTLY)
            subtract_occluded(tile, job, occlusion);
    }
    return true;
}
