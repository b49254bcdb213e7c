#include "passes/yuv.h"

#include <string.h>

#include "image/format.h"
#include "image/border.h"
#include "image/viewport.h"
#include "renderer/renderer.h"

void rf_yuv_set_blend(struct refocus_renderer *r, uint32_t blend)
{
    struct rf_yuv *yuv = &r->yuv;

    if (!yuv->curve_made || yuv->blend != blend)
        rf_yuv_curve_init(&yuv->curve, yuv->matrix, yuv->range, blend);
    yuv->curve_made = true;
    yuv->blend = blend;
}

void rf_yuv_begin(struct refocus_renderer *r, const struct refocus_image *photo)
{
    struct rf_yuv *yuv = &r->yuv;

    yuv->on = refocus_format_is_yuv(photo->format);
    if (!yuv->on)
        return;
    yuv->down = rf_chroma_down(photo->format);
    yuv->curve_made = yuv->curve_made && yuv->matrix == photo->matrix && yuv->range == photo->range;
    yuv->matrix = photo->matrix;
    yuv->range = photo->range;
    rf_yuv_set_blend(r, r->blend);
}

/* Pixel (0, 0) of the window is at rows that are a multiple of RF_TILE. */
static uint16_t *chroma_of(const struct refocus_renderer *r, uint16_t *plane)
{
    return plane - (r->view.y0 - (r->view.y0 >> r->yuv.down)) * r->view.stride;
}

void rf_yuv_use(struct refocus_renderer *r)
{
    struct rf_yuv *yuv = &r->yuv;

    if (!yuv->on)
        return;
    yuv->width = (r->view.width + 1) / 2;
    yuv->height = (r->view.height + yuv->down) >> yuv->down;
    yuv->light = chroma_of(r, r->light.channel[1]);
    yuv->smooth = chroma_of(r, r->smooth.channel[1]);
    yuv->behind = chroma_of(r, r->background.light.channel[1]);
    yuv->blur = (int16_t *)chroma_of(r, r->smooth.channel[2]);
    yuv->weight = r->background.light.channel[2];
    yuv->y = r->alpha.at;
    yuv->y_stride = r->alpha.stride;
    yuv->uv_stride = r->view.stride * (ptrdiff_t)sizeof(uint16_t);
    yuv->uv = (uint8_t *)(chroma_of(r, r->light.channel[2]) - r->view.x0) + r->view.x0;
    for (int c = 1; c < 3; c++)
        r->light.channel[c] = r->light.channel[0];
}

struct refocus_image rf_yuv_guide(const struct refocus_renderer *r)
{
    const struct rf_yuv *yuv = &r->yuv;

    return refocus_image_packed(REFOCUS_FORMAT_RGB8, yuv->uv + 2 * yuv->width, r->view.width,
                                r->view.height, yuv->uv_stride);
}

/* A sample's two values n times. */
static void repeat(uint16_t *to, const uint16_t *sample, int n)
{
    const uint16_t a = sample[0], b = sample[1];

    for (int i = 0; i < n; i++) {
        to[2 * i] = a;
        to[2 * i + 1] = b;
    }
}

void rf_extend_chroma(const struct refocus_renderer *r, void *plane, int c0, int c1)
{
    const int w = 2 * r->yuv.width, left = r->view.pad & ~1;
    const int right = r->view.tiles_x * RF_TILE + r->view.pad;
    /* offsets of half a row round up */
    const int beyond = r->yuv.down ? r->view.pad / 2 + 1 : r->view.pad;
    const int below = (RF_TILE >> r->yuv.down) + beyond;
    const size_t bytes = (size_t)(left + right) * 2;
    uint16_t *const first = (uint16_t *)plane - left;

    for (int y = c0; y < c1; y++) {
        uint16_t *row = (uint16_t *)plane + y * r->view.stride;

        repeat(row - left, row, left / 2);
        repeat(row + w, row + w - 2, (right - w) / 2);
    }
    if (c0 == 0)
        for (int y = 1; y <= beyond; y++)
            memcpy(first - y * r->view.stride, first, bytes);
    if (c1 == r->yuv.height)
        for (int y = 0; y < below; y++)
            memcpy(first + (r->yuv.height + y) * r->view.stride,
                   first + (r->yuv.height - 1) * r->view.stride, bytes);
}

/* Row cy of chroma and the rows that share it, from the codes that are kept. The pixel beside
 * an odd edge, which planes have room for, is made of scratch: rows of codes have none. */
static void convert_codes(const struct refocus_renderer *r, uint8_t *scratch, int cy)
{
    const struct rf_yuv *yuv = &r->yuv;
    const int w = r->view.width, y = cy << yuv->down;
    const bool two = yuv->down && y + 1 < r->view.height;
    const uint8_t *luma[2] = {yuv->y + y * yuv->y_stride, yuv->y + (y + two) * yuv->y_stride};
    uint16_t *const out[2] = {r->light.channel[0] + y * r->view.stride,
                              r->light.channel[0] + (y + two) * r->view.stride};

    if (w % 2) {
        for (int i = 0; i < 2; i++) {
            uint8_t *row = scratch + i * (w + 1);

            memcpy(row, luma[i], (size_t)w);
            row[w] = row[w - 1];
            luma[i] = row;
        }
    }
    r->exec.kernels->encode(out, yuv->light + cy * r->view.stride, luma,
                            yuv->uv + cy * yuv->uv_stride, &yuv->curve, yuv->width);
}

static uint8_t code_of(int tone)
{
    return (uint8_t)((rf_clip_tone(tone) + 2) / 4);
}

/* The colours of a row, as far as they tell one thing from another. */
static void guide_row(const struct refocus_renderer *r, uint8_t *out, int y)
{
    const struct rf_yuv *yuv = &r->yuv;
    const struct rf_yuv_curve *const curve = &yuv->curve;
    const uint8_t *luma = yuv->y + y * yuv->y_stride;
    const uint8_t *uv = yuv->uv + (y >> yuv->down) * yuv->uv_stride;

    for (int x = 0; x < r->view.width; x++, out += 3) {
        const int tone = curve->luma[luma[x]], at = x & ~1;

        out[0] = code_of(tone + rf_more(curve, 1, uv[at + 1]));
        out[1] = code_of(tone - rf_less_green(curve, uv[at], uv[at + 1]));
        out[2] = code_of(tone + rf_more(curve, 0, uv[at]));
    }
}

static void swap_pairs(uint8_t *restrict to, const uint8_t *restrict from, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t pair;

        memcpy(&pair, from + 2 * x, sizeof pair);
        pair = (uint16_t)(pair << 8 | pair >> 8);
        memcpy(to + 2 * x, &pair, sizeof pair);
    }
}

/*
 * The codes are copied first, whole rows of a plane at a time and in order: camera memory may be
 * uncached, and slow to read in pieces. Only those that lie in between others take a second
 * copy, from `scratch`.
 */
static void keep_420(const struct refocus_renderer *r, const struct refocus_image *photo,
                     uint8_t *scratch, int cy)
{
    const struct rf_yuv *yuv = &r->yuv;
    const int w = yuv->width;
    uint8_t *uv = yuv->uv + cy * yuv->uv_stride;

    if (photo->format == REFOCUS_FORMAT_NV12) {
        memcpy(uv, photo->plane[1] + cy * photo->stride[1], 2 * (size_t)w);
        return;
    }
    if (photo->format == REFOCUS_FORMAT_NV21) {
        memcpy(scratch, photo->plane[1] + cy * photo->stride[1], 2 * (size_t)w);
        swap_pairs(uv, scratch, w);
        return;
    }
    memcpy(scratch, photo->plane[1] + cy * photo->stride[1], (size_t)w);
    memcpy(scratch + w, photo->plane[2] + cy * photo->stride[2], (size_t)w);
    for (int x = 0; x < w; x++) {
        uv[2 * x] = scratch[x];
        uv[2 * x + 1] = scratch[w + x];
    }
}

static void split(uint8_t *restrict first, uint8_t *restrict second, const uint8_t *restrict pairs,
                  int n)
{
    for (int x = 0; x < n; x++) {
        first[x] = pairs[2 * x];
        second[x] = pairs[2 * x + 1];
    }
}

static void keep_422(const struct refocus_renderer *r, const struct refocus_image *photo,
                     uint8_t *scratch, int row)
{
    const int w = r->view.width, even = w & ~1;
    uint8_t *y = r->yuv.y + row * r->yuv.y_stride, *uv = r->yuv.uv + row * r->yuv.uv_stride;

    memcpy(scratch, photo->plane[0] + row * photo->stride[0], 4 * (size_t)r->yuv.width);
    split(y, uv, scratch, even);
    if (even < w) {
        y[even] = scratch[2 * even];
        uv[even] = scratch[2 * even + 1];
        uv[w] = scratch[2 * even + 3];
    }
}

static void convert_chroma_rows(struct refocus_renderer *r, uint8_t *scratch, int c0, int c1)
{
    const int y0 = c0 << r->yuv.down, end = c1 << r->yuv.down;

    for (int cy = c0; cy < c1; cy++)
        convert_codes(r, scratch, cy);
    rf_extend_rows(&r->view, r->light.channel[0], r->view.stride, y0,
                   end < r->view.height ? end : r->view.height);
    rf_extend_chroma(r, r->yuv.light, c0, c1);
}

void rf_yuv_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo,
                         const struct refocus_image *guide, uint8_t *scratch, int y0, int y1)
{
    const int c0 = y0 >> r->yuv.down, c1 = rf_chroma_end(r, y1);

    if (r->yuv.down)
        for (int y = y0; y < y1; y++)
            memcpy(r->yuv.y + y * r->yuv.y_stride, photo->plane[0] + y * photo->stride[0],
                   (size_t)r->view.width);
    for (int cy = c0; cy < c1; cy++) {
        if (r->yuv.down)
            keep_420(r, photo, scratch, cy);
        else
            keep_422(r, photo, scratch, cy);
    }
    convert_chroma_rows(r, scratch, c0, c1);
    for (int y = y0; guide && y < y1; y++)
        guide_row(r, guide->plane[0] + y * guide->stride[0], y);
}

void rf_yuv_reblend_rows(struct refocus_renderer *r, uint8_t *scratch, int y0, int y1)
{
    convert_chroma_rows(r, scratch, y0 >> r->yuv.down, rf_chroma_end(r, y1));
}

void rf_yuv_blur_rows(struct refocus_renderer *r, int y0, int y1)
{
    const struct rf_yuv *yuv = &r->yuv;
    const int c0 = y0 >> yuv->down, c1 = rf_chroma_end(r, y1);

    for (int cy = c0; cy < c1; cy++) {
        const int y = cy << yuv->down;
        const int16_t *upper = r->blur.at + y * r->view.stride;
        const int16_t *lower = yuv->down && y + 1 < r->view.height ? upper + r->view.stride : upper;

        r->exec.kernels->sharpest4(yuv->blur + cy * r->view.stride, upper, lower, yuv->width);
    }
    rf_extend_chroma(r, yuv->blur, c0, c1);
}

/* A plane and its blur, and how far apart neighbours are. */
struct filter {
    uint16_t *out;
    const uint16_t *in;
    const uint16_t *taken; /* in place of it, of tiles that lamps are taken out of; or NULL */
    const int16_t *blur;
    const int *above; /* |s| that the steps begin at */
    bool fades;       /* see rf_prefilter_rows() */
    int number;       /* of this one */
    int across;       /* elements from neighbour to neighbour; rows are 1 << number */
    uint16_t *scratch;
};

/* n elements of a row, from `at` on. */
static void smooth_run(const struct refocus_renderer *r, const struct filter *f, const uint16_t *in,
                       ptrdiff_t at, int n)
{
    const int step = f->across, least = f->above[f->number];
    const int over = rf_prefilter_over(least, f->fades);
    const ptrdiff_t down = r->view.stride << f->number;
    const uint16_t *from = in + at - step;
    const int16_t *s = f->blur + at;
    uint16_t *const row = f->scratch + step;

    r->exec.kernels->smooth1(row - step, from, s - step, down, least, over, n + 2 * step);
    r->exec.kernels->smooth1(f->out + at, row, s, step, least, over, n);
}

/* Rows y0 to y1 - 1, as wide as w, of a row of tiles. */
static void smooth_rows(const struct refocus_renderer *r, const struct filter *f, int ty, int y0,
                        int y1, int w)
{
    const struct rf_bins *bins = r->bins + (size_t)ty * r->view.tiles_x;

    for (int tx = 0, end; tx < r->view.tiles_x; tx = end) {
        const enum rf_task task = rf_prefilter_task(r, f->above, f->number, tx, ty);
        const bool taken = f->taken && bins[tx].taken;
        const uint16_t *const in = taken ? f->taken : f->in;
        const int x0 = tx * RF_TILE;
        int n;

        for (end = tx + 1; end < r->view.tiles_x &&
                           rf_prefilter_task(r, f->above, f->number, end, ty) == task &&
                           taken == (f->taken && bins[end].taken);)
            end++;
        n = (end * RF_TILE < w ? end * RF_TILE : w) - x0;
        for (int y = y0; y < y1 && task != RF_SKIP; y++) {
            const ptrdiff_t at = y * r->view.stride + x0;

            if (task == RF_FILTER)
                smooth_run(r, f, in, at, n);
            else
                memcpy(f->out + at, in + at, (size_t)n * 2);
        }
    }
}

void rf_yuv_prefilter_luma(struct refocus_renderer *r, uint16_t *out, const uint16_t *in,
                           const int above[RF_PREFILTER_STEPS], bool fades, int step,
                           uint16_t *scratch, int ty)
{
    const struct filter filter = {
        out,        in,        step == 0 ? r->background.light.channel[0] : NULL,
        r->blur.at, above,     fades,
        step,       1 << step, scratch};

    smooth_rows(r, &filter, ty, rf_band_start(ty), rf_band_end(&r->view, ty), r->view.width);
    rf_extend_rows(&r->view, out, r->view.stride, rf_band_start(ty), rf_band_end(&r->view, ty));
}

void rf_yuv_prefilter_chroma(struct refocus_renderer *r, uint16_t *out, const uint16_t *in,
                             const int above[RF_PREFILTER_STEPS], bool fades, int step,
                             uint16_t *scratch, int ty)
{
    const struct filter filter = {out,   in,   NULL,      r->yuv.blur, above,
                                  fades, step, 2 << step, scratch};
    const int c0 = rf_band_start(ty) >> r->yuv.down;
    const int c1 = rf_chroma_end(r, rf_band_end(&r->view, ty));

    smooth_rows(r, &filter, ty, c0, c1, 2 * r->yuv.width);
    rf_extend_chroma(r, out, c0, c1);
}
