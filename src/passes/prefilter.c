/* prefilter.c: smooths light where rays lie so far apart that they would miss pixels. */
#include "passes/prefilter.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "image/border.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum {
    RUN = 256, /* columns at a time of three planes, three times that of one */
    MARGIN = 2 << (RF_PREFILTER_STEPS - 1),
};
static_assert(MARGIN >= 2 * (1 << (RF_PREFILTER_STEPS - 1)), "neighbours of chroma, two a sample");

/* How many tiles or bands away the neighbours of a step are at most: those of chroma are as many
 * samples away, of two pixels. */
static int tiles_away(int number, bool chroma)
{
    return ((chroma ? 2 << number : 1 << number) + RF_TILE - 1) / RF_TILE;
}
static_assert(65535 * RF_SMOOTH_THIRD <= INT32_MAX && 65535 * RF_SMOOTH_THIRD >> 16 == 10922,
              "the whole share, Q15");

void rf_prefilter_bounds(int above[RF_PREFILTER_STEPS], int steps, int rays, int largest, int unit)
{
    for (int i = 0; i < RF_PREFILTER_STEPS; i++) {
        const double gap = 1.5 * (1 << i);
        const double s = 256 * gap * sqrt(rays / 3.14159265358979) / (1 << unit);
        const bool there = rays != REFOCUS_RAYS_FULL && i < steps;

        above[i] = there && s < largest ? (int)s : INT16_MAX;
    }
}

void rf_prefilter_chroma_bounds(int above[RF_PREFILTER_STEPS],
                                const int luma_above[RF_PREFILTER_STEPS],
                                const struct rf_ray_set *set)
{
    const double times = 2 * sqrt((double)set->shared / set->count);

    for (int i = 0; i < RF_PREFILTER_STEPS; i++) {
        const double s = times * luma_above[i];

        above[i] = s < INT16_MAX ? (int)s : INT16_MAX;
    }
}

/* A step for some planes that lie alike: three of light, luminance, or chroma. */
struct step {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_bins *bins;
    const int *above;
    int number, least, over;
    int planes; /* 3 or 1 */
    bool chroma;
    int width; /* elements of a row */
    uint16_t *const *out, *const *in;
    uint16_t *const *subtracted; /* in place of `in` for tiles that are marked so, or NULL */
    const int16_t *blur;
    ptrdiff_t stride, down; /* elements to the next row, and to the row that is a neighbour */
    int across;             /* elements to the neighbour in a row */
};

/* Whether a tile holds blurs above `least`. */
static bool is_wide(const struct step *step, int tx, int ty, int least)
{
    const struct rf_bins *bins = &step->bins[(size_t)ty * step->view->tiles_x + tx];

    return bins->most > least || -bins->least > least;
}

static bool is_wide_near(const struct step *step, int tx, int ty, int away, int least)
{
    for (int y = ty - away; y <= ty + away; y++)
        for (int x = tx - away; x <= tx + away; x++)
            if (x >= 0 && x < step->view->tiles_x && y >= 0 && y < step->view->tiles_y &&
                is_wide(step, x, y, least))
                return true;
    return false;
}

/* The task of a step in a tile. */
enum task { SKIP, COPY, FILTER };

/* Steps 1 and 2 are there and back between two planes, and so are 3 and 4, and 5 and 6, so that
 * tiles that the first of them leaves alone need not be moved at all, but where the second looks at
 * them. */
static enum task task_of(const struct step *step, int tx, int ty)
{
    const int number = step->number, *above = step->above;

    if (is_wide(step, tx, ty, above[number]))
        return FILTER;
    if (number == 0 ||
        (number % 2
             ? is_wide_near(step, tx, ty, tiles_away(number + 1, step->chroma), above[number])
             : is_wide(step, tx, ty, above[number - 1])))
        return COPY;
    return SKIP;
}

/* n columns of a row, from `at` on, n at most RUN: three rows to one, then columns. */
static void smooth3_run(const struct step *step, uint16_t *const in[3], ptrdiff_t at, int n)
{
    const int across = step->across;
    const ptrdiff_t from = at - across;
    const int16_t *s = step->blur;
    uint16_t *const *out = step->out;
    uint16_t row[3][RUN + 2 * MARGIN];

    step->exec->kernels->smooth3(
        (uint16_t *const[3]){row[0], row[1], row[2]},
        (const uint16_t *const[3]){in[0] + from, in[1] + from, in[2] + from}, s + from, step->down,
        step->least, step->over, n + 2 * across);
    step->exec->kernels->smooth3(
        (uint16_t *const[3]){out[0] + at, out[1] + at, out[2] + at},
        (const uint16_t *const[3]){row[0] + across, row[1] + across, row[2] + across}, s + at,
        across, step->least, step->over, n);
}

static void smooth1_run(const struct step *step, const uint16_t *in, ptrdiff_t at, int n)
{
    const int across = step->across;
    const ptrdiff_t from = at - across;
    uint16_t row[3 * RUN + 2 * MARGIN];

    step->exec->kernels->smooth1(row, in + from, step->blur + from, step->down, step->least,
                                 step->over, n + 2 * across);
    step->exec->kernels->smooth1(step->out[0] + at, row + across, step->blur + at, across,
                                 step->least, step->over, n);
}

static void smooth_row(const struct step *step, uint16_t *const *in, ptrdiff_t at, int n)
{
    const int run = step->planes == 3 ? RUN : 3 * RUN;

    for (int x = 0; x < n; x += run) {
        const int left = n - x < run ? n - x : run;

        if (step->planes == 3)
            smooth3_run(step, in, at + x, left);
        else
            smooth1_run(step, in[0], at + x, left);
    }
}

/* Rows y0 to y1 - 1 of a row of tiles. */
static void filter_rows(const struct step *step, int ty, int y0, int y1)
{
    const int tiles = step->view->tiles_x;
    const struct rf_bins *bins = step->bins + (size_t)ty * tiles;

    for (int tx = 0, end; tx < tiles; tx = end) {
        const enum task task = task_of(step, tx, ty);
        const bool subtracted = step->subtracted && bins[tx].subtracted;
        uint16_t *const *in = subtracted ? step->subtracted : step->in;
        const int x0 = tx * RF_TILE;
        int n;

        for (end = tx + 1; end < tiles && task_of(step, end, ty) == task &&
                           subtracted == (step->subtracted && bins[end].subtracted);)
            end++;
        n = (end * RF_TILE < step->width ? end * RF_TILE : step->width) - x0;
        for (int y = y0; y < y1 && task != SKIP; y++) {
            const ptrdiff_t at = y * step->stride + x0;

            if (task == FILTER)
                smooth_row(step, in, at, n);
            for (int c = 0; task == COPY && c < step->planes; c++)
                memcpy(step->out[c] + at, in[c] + at, (size_t)n * 2);
        }
    }
}

/* From the photo to `smooth`, and from there by way of `spare`, which is not in use yet. */
static void filter_light(const struct rf_executor *exec, const struct rf_viewport *view,
                         const struct rf_prefilter *pass, int number, int ty)
{
    const struct rf_light_q12 *in = number % 2   ? &pass->smooth
                                    : number > 0 ? &pass->spare
                                                 : &pass->light;
    const struct rf_light_q12 *out = number % 2 ? &pass->spare : &pass->smooth;
    const int y0 = rf_band_start(ty), y1 = rf_band_end(view, ty);
    const struct step step = {
        .exec = exec,
        .view = view,
        .bins = pass->bins,
        .above = pass->above,
        .number = number,
        .least = pass->above[number],
        .over = rf_prefilter_over(pass->above[number], pass->fades),
        .planes = pass->chroma ? 1 : 3,
        .width = view->width,
        .out = out->channel,
        .in = in->channel,
        .subtracted = number == 0 ? pass->spare.channel : NULL,
        .blur = pass->blur.at,
        .stride = pass->blur.stride,
        .down = pass->blur.stride << number,
        .across = 1 << number,
    };

    filter_rows(&step, ty, y0, y1);
    for (int c = 0; c < step.planes; c++)
        rf_extend_rows(view, out->channel[c], out->stride, y0, y1);
}

static void filter_chroma(const struct rf_executor *exec, const struct rf_viewport *view,
                          const struct rf_prefilter *pass, int number, int ty)
{
    const struct rf_prefilter_chroma *chroma = pass->chroma;
    uint16_t *const in = number % 2   ? chroma->smooth.at
                         : number > 0 ? chroma->spare.at
                                      : chroma->light.at;
    uint16_t *const out = number % 2 ? chroma->spare.at : chroma->smooth.at;
    const int down = chroma->size.down;
    const int c0 = rf_band_start(ty) >> down, c1 = rf_chroma_end(down, rf_band_end(view, ty));
    const struct step step = {
        .exec = exec,
        .view = view,
        .bins = pass->bins,
        .above = chroma->above,
        .number = number,
        .least = chroma->above[number],
        .over = rf_prefilter_over(chroma->above[number], pass->fades),
        .planes = 1,
        .chroma = true,
        .width = 2 * chroma->size.width,
        .out = &out,
        .in = &in,
        .blur = chroma->blur.at,
        .stride = chroma->blur.stride,
        .down = chroma->blur.stride << number,
        .across = 2 << number,
    };

    filter_rows(&step, ty, c0, c1);
    rf_extend_chroma(view, &chroma->size, *step.out, chroma->smooth.stride, c0, c1);
}

/* One step after the other. That of a band needs the step before of those that it looks at, too,
 * and is made by whoever makes the last of these, while they are in the cache. */
struct job {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_prefilter *pass;
    atomic_uchar (*ready)[RF_MAX_BANDS]; /* [RF_PREFILTER_STEPS]: bands that it waits for */
};

static void filter_from(struct job *job, int number, int band)
{
    const struct rf_prefilter *pass = job->pass;
    const int last = rf_bands(job->view) - 1, away = tiles_away(number + 1, pass->chroma);

    filter_light(job->exec, job->view, pass, number, band);
    if (pass->chroma && number < pass->chroma->steps)
        filter_chroma(job->exec, job->view, pass, number, band);
    if (number + 1 == pass->steps)
        return;
    for (int b = rf_larger(band - away, 0); b <= rf_smaller(band + away, last); b++)
        if (atomic_fetch_add(&job->ready[number][b], 1) ==
            rf_smaller(b + away, last) - rf_larger(b - away, 0))
            filter_from(job, number + 1, b);
}

static void filter_band(void *context, int band, int worker)
{
    (void)worker;
    filter_from(context, 0, band);
}

uint64_t rf_prefilter_share(void)
{
    return sizeof(atomic_uchar[RF_PREFILTER_STEPS][RF_MAX_BANDS]);
}

void rf_prefilter(const struct rf_executor *exec, const struct rf_viewport *view,
                  const struct rf_prefilter *pass)
{
    /* Bands need no share of their worker. */
    struct job job = {
        .exec = exec, .view = view, .pass = pass, .ready = rf_share(&exec->shares, 0)};

    memset(job.ready, 0, rf_prefilter_share());
    rf_pool_run(exec->pool, filter_band, &job, rf_bands(view));
}
