/* inpaint.c: push and pull of the pyramid that inpaints the hidden background. */
#include "background/inpaint.h"

#include <string.h>

#include "image/border.h"
#include "kernels/kernels.h"
#include "support/compare.h"

enum { BAND = 16, SMALL = 64 }; /* rows; levels that are not worth sharing out */

void rf_pyramid_shape(struct rf_pyramid *pyramid, int width, int height)
{
    int i = 0;

    pyramid->level[0].width = width;
    pyramid->level[0].height = height;
    while (width > 1 || height > 1) {
        struct rf_level *level = &pyramid->level[++i];

        width = (width + 1) / 2;
        height = (height + 1) / 2;
        level->width = width;
        level->height = height;
        level->light.stride = level->blur.stride = (width + 1) & ~1;
    }
    pyramid->levels = i;
}

/* Makes rows of level i + 1 from level i. */
static void push_rows(const struct rf_executor *exec, const struct rf_pyramid *pyramid, int i,
                      int y0, int y1)
{
    const struct rf_level fine = pyramid->level[i], coarse = pyramid->level[i + 1];
    const ptrdiff_t stride = fine.blur.stride;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * coarse.blur.stride, a = 2 * y * stride;
        const ptrdiff_t b = 2 * y + 1 < fine.height ? a + stride : a;
        uint16_t *const *from = fine.light.channel, *const *to = coarse.light.channel;
        uint16_t *const out[3] = {to[0] + at, to[1] + at, to[2] + at};
        const uint16_t *const upper[3] = {from[0] + a, from[1] + a, from[2] + a};
        const uint16_t *const lower[3] = {from[0] + b, from[1] + b, from[2] + b};

        exec->kernels->push(out, coarse.blur.at + at, upper, lower, fine.blur.at + a,
                            fine.blur.at + b, pyramid->apart, coarse.width);
        if (coarse.width % 2)
            coarse.blur.at[at + coarse.width] = RF_NO_BLUR;
    }
}

void rf_background_push_band(const struct rf_executor *exec, const struct rf_pyramid *pyramid,
                             int band, int from, int to)
{
    for (int i = from; i < to && i < RF_BAND_LEVELS; i++) {
        const int height = pyramid->level[i + 1].height, end = (band + 1) * RF_TILE >> (i + 1);

        push_rows(exec, pyramid, i, band * RF_TILE >> (i + 1), end < height ? end : height);
    }
}

static inline bool all_known(const int16_t *blur, int n)
{
    int16_t least = 0;

    for (int x = 0; x < n; x++)
        least = blur[x] < least ? blur[x] : least;
    return least != RF_NO_BLUR;
}

/* Whether the step from x on of n blurs is known. Most are whole: their loop has no ends to mind.
 */
static inline bool is_known(const int16_t *blur, int x, int n)
{
    return x + RF_UNKNOWN_STEP <= n ? all_known(blur + x, RF_UNKNOWN_STEP)
                                    : all_known(blur + x, n - x);
}

bool rf_next_unknown(const int16_t *blur, int n, struct rf_unknown *run)
{
    int x = run->x1 / RF_UNKNOWN_STEP * RF_UNKNOWN_STEP; /* the step after the run is known */

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

/* Pulls a row of level i from the next level, in so many planes of light. */
static void pull_row(const struct rf_executor *exec, const struct rf_pyramid *pyramid, int i,
                     int planes, uint16_t *scratch, int y)
{
    const struct rf_level *fine = &pyramid->level[i], *coarse = &pyramid->level[i + 1];
    const int near_y = y / 2, width = fine->width;
    int far_y = y % 2 ? near_y + 1 : near_y - 1;
    int16_t *const blur = fine->blur.at + y * fine->blur.stride;
    const ptrdiff_t at = y * fine->light.stride, near = near_y * coarse->light.stride;
    struct rf_unknown run = {0};
    ptrdiff_t far;

    if (far_y < 0 || far_y >= coarse->height)
        far_y = near_y;
    far = far_y * coarse->light.stride;
    while (rf_next_unknown(blur, width, &run)) {
        const int x = run.x0, parent = x / 2, pairs = (run.x1 - x + 1) / 2;
        const struct rf_mixed_parents mixed = {scratch, (int16_t *)scratch + pairs + 2};
        struct rf_parents parents = {
            .near_blur = coarse->blur.at + near_y * coarse->blur.stride + parent,
            .far_blur = coarse->blur.at + far_y * coarse->blur.stride + parent,
            .apart = pyramid->apart,
        };

        for (int c = 0; c < planes; c++) {
            parents.near_light = coarse->light.channel[c] + near + parent;
            parents.far_light = coarse->light.channel[c] + far + parent;
            exec->kernels->pull(fine->light.channel[c] + at + x, blur + x, &parents, mixed, pairs);
        }
        exec->kernels->pull_blur(blur + x, &parents, mixed.blur, pairs);
    }
}

/* Repeats the outermost pixels of rows y0 to y1 - 1 of level 0. */
static void extend_background(const struct rf_viewport *view, const struct rf_level *level,
                              int planes, int y0, int y1)
{
    for (int c = 0; c < planes; c++)
        rf_extend_rows(view, level->light.channel[c], level->light.stride, y0, y1);
    rf_extend_rows(view, level->blur.at, level->blur.stride, y0, y1);
}

/* Push from a level to the next one, or pull back to it. */
struct step {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_pyramid *pyramid;
    int level;
};

static int end_of(int band, int height)
{
    return (band + 1) * BAND < height ? (band + 1) * BAND : height;
}

static void push_item(void *context, int band, int worker)
{
    const struct step *step = context;

    (void)worker;
    push_rows(step->exec, step->pyramid, step->level, band * BAND,
              end_of(band, step->pyramid->level[step->level + 1].height));
}

static void pull_item(void *context, int band, int worker)
{
    const struct step *step = context;
    const struct rf_level *level = &step->pyramid->level[step->level];
    const int y0 = band * BAND, y1 = end_of(band, level->height);

    for (int y = y0; y < y1; y++)
        pull_row(step->exec, step->pyramid, step->level, 3, rf_scratch(step->exec, worker), y);
    if (step->level == 0)
        extend_background(step->view, level, 3, y0, y1);
}

static void run(struct step *step, rf_work_fn *work, int height)
{
    const int bands = (height + BAND - 1) / BAND;

    if (height > SMALL)
        rf_pool_run(step->exec->pool, work, step, bands);
    else
        for (int band = 0; band < bands; band++)
            work(step, band, 0);
}

void rf_background_push(const struct rf_executor *exec, const struct rf_pyramid *pyramid, int from,
                        int to)
{
    struct step step = {.exec = exec, .pyramid = pyramid, .level = from};

    for (; step.level < to; step.level++)
        run(&step, push_item, pyramid->level[step.level + 1].height);
}

void rf_background_pull(const struct rf_executor *exec, const struct rf_viewport *view,
                        const struct rf_pyramid *pyramid, int from, int to)
{
    struct step step = {exec, view, pyramid, to - 1};

    for (; step.level >= from; step.level--)
        run(&step, pull_item, pyramid->level[step.level].height);
    if (pyramid->levels == 0) /* a picture of one pixel: nothing is unknown */
        extend_background(view, &pyramid->level[0], 3, 0, 1);
}

struct yuv_step {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_pyramid *pyramid;
    const struct rf_inpaint_chroma *chroma;
};

/* How many of the 2 x 2 pixels of a block are known. */
static int known_of(const struct rf_level *fine, int x, int y)
{
    const int16_t *const blur = fine->blur.at + 2 * y * fine->blur.stride + 2 * x;
    int known = 0;

    for (int i = 0; i < 4; i++)
        known += blur[i / 2 * fine->blur.stride + i % 2] != RF_NO_BLUR;
    return known;
}

/* Whether some of n pixels of two rows are known and others are not. */
static bool is_mixed(const int16_t *restrict upper, const int16_t *restrict lower, int n)
{
    uint16_t known = 0, unknown = 0;

    for (int i = 0; i < n; i++) {
        known |= (uint16_t)((upper[i] != RF_NO_BLUR) | (lower[i] != RF_NO_BLUR));
        unknown |= (uint16_t)((upper[i] == RF_NO_BLUR) | (lower[i] == RF_NO_BLUR));
    }
    return known && unknown;
}

/* Gives block (x, y) of level 1 the mean chroma of the blocks around all of which is known, if
 * there are any. */
static void take_around(const struct yuv_step *step, int x, int y)
{
    const struct rf_level *const fine = &step->pyramid->level[0], *const coarse = fine + 1;
    const struct rf_chroma_q12 smooth = step->chroma->smooth;
    const int w = step->view->width / 2, h = step->view->height / 2;
    const int rows = step->chroma->size.down ? 1 : 2; /* a block has so many of samples */
    uint32_t sum[2] = {0, 0}, count = 0;

    for (int i = 0; i < 9; i++) {
        const int nx = x + i % 3 - 1, ny = y + i / 3 - 1;

        if (nx < 0 || ny < 0 || nx >= w || ny >= h || known_of(fine, nx, ny) < 4)
            continue;
        for (int k = 0; k < rows; k++, count++)
            for (int c = 0; c < 2; c++)
                sum[c] += smooth.at[(rows * ny + k) * smooth.stride + 2 * nx + c];
    }
    for (int c = 0; c < 2 && count; c++)
        coarse->light.channel[1 + c][y * coarse->light.stride + x] =
            (uint16_t)((sum[c] + count / 2) / count);
}

/* Where some pixels of a block are known and others are foreground, their chroma is a mixture,
 * which would tint what the foreground uncovers: it is replaced in a row of level 1. */
static void replace_mixed(const struct yuv_step *step, int y)
{
    enum { SOME = 16 }; /* blocks that are looked at together */
    const struct rf_level *const fine = &step->pyramid->level[0];
    const int16_t *const upper = fine->blur.at + 2 * y * fine->blur.stride;
    const int w = y < step->view->height / 2 ? step->view->width / 2 : 0;

    for (int x0 = 0; x0 < w; x0 += SOME) {
        const int end = rf_smaller(x0 + SOME, w);

        if (!is_mixed(upper + 2 * x0, upper + fine->blur.stride + 2 * x0, 2 * (end - x0)))
            continue;
        for (int x = x0; x < end; x++) {
            const int known = known_of(fine, x, y);

            if (known > 0 && known < 4)
                take_around(step, x, y);
        }
    }
}

/* Makes level 1 under a row of tiles: BAND of its rows are half as many there. */
static void push_yuv_band(void *context, int band, int worker)
{
    const struct yuv_step *step = context;
    const struct rf_viewport *view = step->view;
    const struct rf_level *fine = &step->pyramid->level[0], *coarse = &step->pyramid->level[1];
    const struct rf_chroma_q12 smooth = step->chroma->smooth;
    const int y0 = rf_band_start(band) / 2, y1 = (rf_band_end(view, band) + 1) / 2;
    const bool shared = step->chroma->size.down;

    (void)worker;
    for (int y = y0; y < y1; y++) {
        const int second = 2 * y + 1 < view->height ? 2 * y + 1 : 2 * y;
        const ptrdiff_t at = y * coarse->light.stride, a = 2 * y * fine->light.stride;
        const ptrdiff_t b = second * fine->light.stride;
        int16_t *const blur = coarse->blur.at + y * coarse->blur.stride;

        step->exec->kernels->push1(coarse->light.channel[0] + at, blur, fine->light.channel[0] + a,
                                   fine->light.channel[0] + b, fine->blur.at + a, fine->blur.at + b,
                                   step->pyramid->apart, coarse->width);
        step->exec->kernels->split2(coarse->light.channel[1] + at, coarse->light.channel[2] + at,
                                    smooth.at + (shared ? y : 2 * y) * smooth.stride,
                                    smooth.at + (shared ? y : second) * smooth.stride,
                                    coarse->width);
        replace_mixed(step, y);
        if (coarse->width % 2)
            blur[coarse->width] = RF_NO_BLUR;
    }
}

/* Keeps the samples of a row of chroma that are known; the pixel beyond an odd width repeats the
 * last one. */
static void restore_known(const struct yuv_step *step, uint16_t *out, int y)
{
    const struct rf_level *fine = &step->pyramid->level[0], *coarse = &step->pyramid->level[1];
    int16_t *const blur = fine->blur.at + y * fine->blur.stride;

    if (fine->width % 2)
        blur[fine->width] = blur[fine->width - 1];
    step->exec->kernels->restore_known2(
        out, step->chroma->smooth.at + y * step->chroma->smooth.stride, blur, coarse->width);
}

/* Makes chroma of rows c0 to c1 - 1 from level 1, before level 0 is pulled: it still tells what is
 * known. */
static void pull_chroma(const struct yuv_step *step, int c0, int c1)
{
    const struct rf_level *coarse = &step->pyramid->level[1];
    const struct rf_inpaint_chroma *chroma = step->chroma;

    for (int y = c0; y < c1; y++) {
        const ptrdiff_t at = (chroma->size.down ? y : y / 2) * coarse->light.stride;
        uint16_t *const out = chroma->background.at + y * chroma->background.stride;

        step->exec->kernels->join2(out, coarse->light.channel[1] + at,
                                   coarse->light.channel[2] + at, coarse->width);
        if (!chroma->size.down) /* known samples have rows of their own */
            restore_known(step, out, y);
    }
    rf_extend_chroma(step->view, &chroma->size, chroma->background.at, chroma->background.stride,
                     c0, c1);
}

static void pull_yuv_band(void *context, int band, int worker)
{
    const struct yuv_step *step = context;
    const int y0 = rf_band_start(band), y1 = rf_band_end(step->view, band);
    const int down = step->chroma->size.down;

    pull_chroma(step, y0 >> down, rf_chroma_end(down, y1));
    for (int y = y0; y < y1; y++)
        pull_row(step->exec, step->pyramid, 0, 1, rf_scratch(step->exec, worker), y);
    extend_background(step->view, &step->pyramid->level[0], 1, y0, y1);
}

/* A picture of one pixel has no pyramid, and nothing is unknown. */
static void copy_pixel(const struct rf_viewport *view, const struct rf_pyramid *pyramid,
                       const struct rf_inpaint_chroma *chroma)
{
    memcpy(chroma->background.at, chroma->smooth.at, 2 * sizeof *chroma->smooth.at);
    extend_background(view, &pyramid->level[0], 1, 0, 1);
    rf_extend_chroma(view, &chroma->size, chroma->background.at, chroma->background.stride, 0, 1);
}

void rf_background_inpaint_yuv(const struct rf_executor *exec, const struct rf_viewport *view,
                               const struct rf_pyramid *pyramid,
                               const struct rf_inpaint_chroma *chroma)
{
    struct yuv_step step = {exec, view, pyramid, chroma};

    if (pyramid->levels == 0) {
        copy_pixel(view, pyramid, chroma);
        return;
    }
    rf_pool_run(exec->pool, push_yuv_band, &step, rf_bands(view));
    rf_background_push(exec, pyramid, 1, pyramid->levels);
    rf_background_pull(exec, view, pyramid, 1, pyramid->levels);
    rf_pool_run(exec->pool, pull_yuv_band, &step, rf_bands(view));
}
