#include "background/background.h"

#include <string.h>

#include "passes/yuv.h"
#include "image/border.h"
#include "image/viewport.h"
#include "renderer/renderer.h"

void rf_background_yuv_mark_rows(struct refocus_renderer *r, uint16_t *scratch, int reach, int y0,
                                 int y1)
{
    const int w = r->view.width;
    uint16_t *row = scratch + RF_SPREAD_MARGIN;
    uint16_t *spare = row + w + 2 * RF_SPREAD_MARGIN;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * r->view.stride;
        const uint16_t *down = r->background.light.channel[0] + at,
                       *up = r->background.light.channel[1] + at;

        for (int x = 0; x < w; x++)
            row[x] = down[x] > up[x] ? down[x] : up[x];
        r->exec.kernels->mark(r->background.blur.at + at, r->blur.at + at,
                              r->exec.kernels->spread_row(row, spare, reach, w), w);
        r->background.blur.at[at + w] = RF_NO_BLUR; /* a column more if the width is odd */
        memcpy(r->background.light.channel[0] + at, r->smooth.channel[0] + at, (size_t)w * 2);
    }
}

/* A row of tiles of the picture; BAND of its rows are half as many of level 1. */
static void push_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    const struct rf_level *level = &r->level[0];
    const struct rf_yuv *yuv = &r->yuv;
    const int y0 = rf_band_start(band) / 2, y1 = (rf_band_end(&r->view, band) + 1) / 2;

    (void)worker;
    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * level->stride, a = 2 * y * r->view.stride;
        const ptrdiff_t b = 2 * y + 1 < r->view.height ? a + r->view.stride : a;
        const uint16_t *upper = yuv->smooth + (yuv->down ? y * r->view.stride : a);

        r->exec.kernels->push1(level->light[0] + at, level->blur + at,
                               r->background.light.channel[0] + a,
                               r->background.light.channel[0] + b, r->background.blur.at + a,
                               r->background.blur.at + b, level->width);
        r->exec.kernels->split2(level->light[1] + at, level->light[2] + at, upper,
                                yuv->down ? upper : yuv->smooth + b, level->width);
        if (level->width % 2)
            level->blur[at + level->width] = RF_NO_BLUR;
    }
}

static void pull_luma_row(struct refocus_renderer *r, uint16_t *scratch, int y)
{
    const struct rf_level *level = &r->level[0];
    const int near_y = y / 2;
    int far_y = y % 2 ? near_y + 1 : near_y - 1;
    const ptrdiff_t at = y * r->view.stride, near = near_y * level->stride;
    struct rf_unknown run = {0};
    ptrdiff_t far;

    if (far_y < 0 || far_y >= level->height)
        far_y = near_y;
    far = far_y * level->stride;
    while (rf_next_unknown(r->background.blur.at + at, r->view.width, &run)) {
        const int x = run.x0, parent = x / 2, pairs = (run.x1 - x + 1) / 2;

        r->exec.kernels->pull(r->background.light.channel[0] + at + x,
                              r->background.blur.at + at + x, level->light[0] + near + parent,
                              level->light[0] + far + parent, scratch, pairs);
        r->exec.kernels->pull_blur(r->background.blur.at + at + x, level->blur + near + parent,
                                   pairs);
    }
}

static void pull_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    const struct rf_level *level = &r->level[0];
    const struct rf_yuv *yuv = &r->yuv;
    const int y0 = rf_band_start(band), y1 = rf_band_end(&r->view, band);
    const int c0 = y0 >> yuv->down, c1 = (y1 + yuv->down) >> yuv->down;

    for (int y = y0; y < y1; y++)
        pull_luma_row(r, rf_scratch(&r->exec, worker), y);
    rf_extend_rows(&r->view, r->background.light.channel[0], r->view.stride, y0, y1);
    rf_extend_rows(&r->view, r->background.blur.at, r->view.stride, y0, y1);
    for (int y = c0; y < c1; y++) {
        const ptrdiff_t at = (yuv->down ? y : y / 2) * level->stride;

        r->exec.kernels->join2(yuv->behind + y * r->view.stride, level->light[1] + at,
                               level->light[2] + at, level->width);
        if (!yuv->down) /* what is known has rows of its own */
            r->exec.kernels->keep2(yuv->behind + y * r->view.stride,
                                   yuv->smooth + y * r->view.stride,
                                   r->blur.at + y * r->view.stride,
                                   r->background.blur.at + y * r->view.stride, level->width);
    }
    rf_extend_chroma(r, yuv->behind, c0, c1);
}

/* A picture of one pixel has no pyramid, and nothing is unknown. */
static void fill_pixel(struct refocus_renderer *r)
{
    memcpy(r->yuv.behind, r->yuv.smooth, 2 * sizeof(uint16_t));
    rf_extend_rows(&r->view, r->background.light.channel[0], r->view.stride, 0, 1);
    rf_extend_rows(&r->view, r->background.blur.at, r->view.stride, 0, 1);
    rf_extend_chroma(r, r->yuv.behind, 0, 1);
}

void rf_background_yuv_fill(struct refocus_renderer *r)
{
    if (r->levels == 0) {
        fill_pixel(r);
        return;
    }
    rf_pool_run(&r->pool, push_band, r, rf_bands(&r->view));
    rf_background_push(r, 1, r->levels);
    rf_background_pull(r, 1, r->levels);
    rf_pool_run(&r->pool, pull_band, r, rf_bands(&r->view));
}
