#include "background/background.h"

#include <string.h>

#include "passes/planes.h"
#include "image/viewport.h"
#include "renderer/renderer.h"

/* Dilated values are s + 2^15, so that 0 lies below all of them. */
static void bias_row(const struct refocus_renderer *r, uint16_t *m, int y)
{
    const int16_t *s = r->blur.at + y * r->view.stride;

    for (int x = 0; x < r->view.width; x++)
        m[x] = (uint16_t)((uint16_t)s[x] ^ 0x8000);
    m[-1] = m[r->view.width] = 0;
}

/* Steps straight and diagonally from above, into one plane, or from below, into
 * another. */
void rf_background_dilate(struct refocus_renderer *r, bool upwards)
{
    const int first = upwards ? r->view.height - 1 : 0, step = upwards ? -1 : 1;
    uint16_t *row = r->background.light.channel[upwards] + first * r->view.stride;

    for (int i = 0; i < r->view.height; i++, row += step * r->view.stride) {
        if (i % 16 == 0 && rf_cancelled(&r->exec))
            return;
        bias_row(r, row, first + i * step);
        if (i > 0)
            r->exec.kernels->dilate_from(row, row - step * r->view.stride, r->view.width);
    }
}

void rf_background_mark_rows(struct refocus_renderer *r, uint16_t *scratch, int reach, int y0,
                             int y1)
{
    const int w = r->view.width;
    uint16_t *row = scratch + RF_SPREAD_MARGIN;
    uint16_t *spare = row + w + 2 * RF_SPREAD_MARGIN;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * r->view.stride;
        const uint16_t *down = r->background.light.channel[0] + at,
                       *up = r->background.light.channel[1] + at;
        const uint16_t *dilated;

        for (int x = 0; x < w; x++)
            row[x] = down[x] > up[x] ? down[x] : up[x];
        dilated = r->exec.kernels->spread_row(row, spare, reach, w);
        r->exec.kernels->mark(r->background.blur.at + at, r->blur.at + at, dilated, w);
        r->background.blur.at[at + w] = RF_NO_BLUR; /* a column more if the width is odd */
        for (int c = 0; c < 3; c++)
            memcpy(r->background.light.channel[c] + at, r->smooth.channel[c] + at, (size_t)w * 2);
    }
}

/* Level 0 of the pyramid is the padded layer itself. */
static struct rf_level level_of(const struct refocus_renderer *r, int i)
{
    if (i > 0)
        return r->level[i - 1];
    return (struct rf_level){
        .width = r->view.width,
        .height = r->view.height,
        .stride = r->view.stride,
        .light = {r->background.light.channel[0], r->background.light.channel[1],
                  r->background.light.channel[2]},
        .blur = r->background.blur.at,
    };
}

static void push_rows(struct refocus_renderer *r, int i, int y0, int y1)
{
    const struct rf_level fine = level_of(r, i), coarse = level_of(r, i + 1);

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * coarse.stride, a = 2 * y * fine.stride;
        const ptrdiff_t b = 2 * y + 1 < fine.height ? a + fine.stride : a;
        uint16_t *const out[3] = {coarse.light[0] + at, coarse.light[1] + at, coarse.light[2] + at};
        const uint16_t *const upper[3] = {fine.light[0] + a, fine.light[1] + a, fine.light[2] + a};
        const uint16_t *const lower[3] = {fine.light[0] + b, fine.light[1] + b, fine.light[2] + b};

        r->exec.kernels->push(out, coarse.blur + at, upper, lower, fine.blur + a, fine.blur + b,
                              coarse.width);
        if (coarse.width % 2)
            coarse.blur[at + coarse.width] = RF_NO_BLUR;
    }
}

void rf_background_push_band(struct refocus_renderer *r, int band, int levels)
{
    for (int i = 0; i < levels && i < RF_BAND_LEVELS; i++) {
        const int height = level_of(r, i + 1).height, end = (band + 1) * RF_TILE >> (i + 1);

        push_rows(r, i, band * RF_TILE >> (i + 1), end < height ? end : height);
    }
}

static inline bool all_known(const int16_t *blur, int n)
{
    int16_t least = 0;

    for (int x = 0; x < n; x++)
        least = blur[x] < least ? blur[x] : least;
    return least != RF_NO_BLUR;
}

/* Whether a step of n blurs from x on is. Most are whole: their loop has no ends to mind. */
static inline bool is_known(const int16_t *blur, int x, int n)
{
    return x + RF_UNKNOWN_STEP <= n ? all_known(blur + x, RF_UNKNOWN_STEP)
                                    : all_known(blur + x, n - x);
}

bool rf_next_unknown(const int16_t *blur, int n, struct rf_unknown *run)
{
    int x = run->x1 / RF_UNKNOWN_STEP * RF_UNKNOWN_STEP; /* a known step, or the first */

    while (x < n && is_known(blur, x, n))
        x += RF_UNKNOWN_STEP;
    if (x >= n)
        return false;
    run->x0 = x > 0 ? x - 2 : 0;
    do
        x += RF_UNKNOWN_STEP;
    while (x < n && !is_known(blur, x, n));
    run->x1 = x + 2 < n ? x + 2 : n;
    return true;
}

static void pull_rows(struct refocus_renderer *r, int i, uint16_t *scratch, int y0, int y1)
{
    const struct rf_level fine = level_of(r, i), coarse = level_of(r, i + 1);

    for (int y = y0; y < y1; y++) {
        const int near_y = y / 2;
        const ptrdiff_t at = y * fine.stride, near = near_y * coarse.stride;
        struct rf_unknown run = {0};
        int far_y = y % 2 ? near_y + 1 : near_y - 1;
        ptrdiff_t far;

        if (far_y < 0 || far_y >= coarse.height)
            far_y = near_y;
        far = far_y * coarse.stride;
        while (rf_next_unknown(fine.blur + at, fine.width, &run)) {
            const int x = run.x0, parent = x / 2, pairs = (run.x1 - x + 1) / 2;

            for (int c = 0; c < 3; c++)
                r->exec.kernels->pull(fine.light[c] + at + x, fine.blur + at + x,
                                      coarse.light[c] + near + parent,
                                      coarse.light[c] + far + parent, scratch, pairs);
            r->exec.kernels->pull_blur(fine.blur + at + x, coarse.blur + near + parent, pairs);
        }
    }
}

struct fill {
    struct refocus_renderer *r;
    int level;
};

enum { BAND = 16, SMALL = 64 }; /* rows; levels that are not worth sharing out */

static int end_of(int band, int height)
{
    return (band + 1) * BAND < height ? (band + 1) * BAND : height;
}

static void push_item(void *context, int band, int worker)
{
    const struct fill *fill = context;

    (void)worker;
    push_rows(fill->r, fill->level, band * BAND,
              end_of(band, level_of(fill->r, fill->level + 1).height));
}

static void pull_item(void *context, int band, int worker)
{
    const struct fill *fill = context;
    struct refocus_renderer *r = fill->r;
    const int y0 = band * BAND, y1 = end_of(band, level_of(r, fill->level).height);

    pull_rows(r, fill->level, rf_scratch(&r->exec, worker), y0, y1);
    if (fill->level == 0) {
        for (int c = 0; c < 3; c++)
            rf_extend_rows(&r->view, r->background.light.channel[c], r->view.stride, y0, y1);
        rf_extend_rows(&r->view, r->background.blur.at, r->view.stride, y0, y1);
    }
}

static void run(struct fill *fill, rf_work_fn *work, int height)
{
    const int bands = (height + BAND - 1) / BAND;

    if (height > SMALL)
        rf_pool_run(&fill->r->pool, work, fill, bands);
    else
        for (int band = 0; band < bands; band++)
            work(fill, band, 0);
}

void rf_background_push(struct refocus_renderer *r, int from, int to)
{
    struct fill fill = {r, from};

    for (; fill.level < to; fill.level++)
        run(&fill, push_item, level_of(r, fill.level + 1).height);
}

void rf_background_pull(struct refocus_renderer *r, int from, int to)
{
    struct fill fill = {r, to - 1};

    for (; fill.level >= from; fill.level--)
        run(&fill, pull_item, level_of(r, fill.level).height);
    if (r->levels == 0) /* a picture of one pixel: nothing is unknown */
        for (int c = 0; c < 4; c++)
            rf_extend_rows(&r->view,
                           c < 3 ? (void *)r->background.light.channel[c] : r->background.blur.at,
                           r->view.stride, 0, 1);
}
