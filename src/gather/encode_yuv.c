/* encode_yuv.c: writes the means of a tile to an output picture of Y, U and V. */
#include "gather/frame.h"
#include "image/format.h"
#include "passes/weights.h"

#include <string.h>

/* Where the samples of one channel of the result lie. */
struct row {
    uint8_t *first;
    int step;         /* bytes from sample to sample */
    ptrdiff_t stride; /* bytes from row to row */
};

/* Finds the samples of Y (i = 0), U (1) or V (2) from pixel (x, y) on. */
static struct row samples(const struct rf_frame *f, int i, int x, int y)
{
    const bool chroma = i > 0, nv21 = f->out->format == REFOCUS_FORMAT_NV21;
    const int down = chroma ? f->yuv->down : 0;
    const int row = (y - f->region.y0) >> down, column = (x - f->region.x0) >> chroma;
    int plane = i, step = 1, at = column;

    if (f->out->format == REFOCUS_FORMAT_YUYV) {
        plane = 0;
        step = chroma ? 4 : 2;
        at = step * column + (chroma ? 2 * i - 1 : 0);
    } else if (chroma && f->out->format != REFOCUS_FORMAT_I420) {
        plane = 1;
        step = 2;
        at = 2 * column + ((i == 2) ^ nv21);
    }
    return (struct row){f->out->plane[plane] + row * f->out->stride[plane] + at, step,
                        f->out->stride[plane]};
}

/* Writes n pixels. Where n is odd, the pixel beside the last one repeats its Y: YUYV holds pairs.
 */
static void put_yuyv(uint8_t *restrict out, const uint8_t *restrict y, const uint8_t *restrict uv,
                     int n)
{
    const int even = n & ~1;

    for (int x = 0; x < even; x++) {
        out[2 * x] = y[x];
        out[2 * x + 1] = uv[x];
    }
    if (even < n) {
        out[2 * even] = out[2 * n] = y[even];
        out[2 * even + 1] = uv[even];
        out[2 * n + 1] = uv[n];
    }
}

static void put_luma(uint8_t *out, const uint8_t *code, int n)
{
    if (n == RF_TILE)
        memcpy(out, code, RF_TILE);
    else
        memcpy(out, code, (size_t)n);
}

/* Writes n pairs of U and V. */
static void put_chroma(struct row u, struct row v, const uint8_t *restrict uv, int n)
{
    if (u.step == 2 && v.first == u.first + 1) { /* NV12 */
        put_luma(u.first, uv, 2 * n);
        return;
    }
    for (int i = 0; i < n; i++) {
        u.first[i * u.step] = uv[2 * i];
        v.first[i * v.step] = uv[2 * i + 1];
    }
}

/* The codes of a part of the picture. */
struct codes {
    const uint8_t *y, *uv; /* from its first pixel on */
    ptrdiff_t y_stride, uv_stride;
};

static void put(const struct rf_frame *f, struct rf_rect rect, const struct codes *codes)
{
    const int n = rect.x1 - rect.x0, down = f->yuv->down;
    const bool yuyv = f->out->format == REFOCUS_FORMAT_YUYV;
    const struct row luma = samples(f, 0, rect.x0, rect.y0);
    const struct row u = samples(f, 1, rect.x0, rect.y0), v = samples(f, 2, rect.x0, rect.y0);

    for (int y = 0; y < rect.y1 - rect.y0; y++) {
        const uint8_t *from = codes->y + y * codes->y_stride;
        uint8_t *to = luma.first + y * luma.stride;

        if (yuyv)
            put_yuyv(to, from, codes->uv + y * codes->uv_stride, n);
        else
            put_luma(to, from, n);
    }
    if (yuyv)
        return;
    for (int y = 0; y < (rect.y1 - rect.y0 + down) >> down; y++)
        put_chroma((struct row){u.first + y * u.stride, u.step, u.stride},
                   (struct row){v.first + y * v.stride, v.step, v.stride},
                   codes->uv + y * codes->uv_stride, (n + 1) / 2);
}

void rf_copy_yuv_tile(const struct rf_frame *f, struct rf_rect rect)
{
    const struct rf_yuv *yuv = f->yuv;
    const struct rf_yuv_codes *own = &f->chroma.codes;
    const struct codes codes = {
        .y = own->y + rect.y0 * own->y_stride + rect.x0,
        .uv = own->uv + (rect.y0 >> yuv->down) * own->uv_stride + rect.x0,
        .y_stride = own->y_stride,
        .uv_stride = own->uv_stride,
    };

    put(f, rect, &codes);
}

/* Repeats the last luma over the pixel beside an odd edge: both share one sample of chroma, which
 * is the mean of its pixels. */
static void repeat_edge(struct rf_decode_job *job, int w, int h)
{
    if (w % 2)
        for (int y = 0; y < h; y++)
            job->luma[y * RF_TILE + w] = job->luma[y * RF_TILE + w - 1];
    if (job->down && h % 2)
        memcpy(job->luma + h * RF_TILE, job->luma + (h - 1) * RF_TILE,
               RF_TILE * sizeof job->luma[0]);
}

/* Copies rows of w codes into a tile. Whole rows have a constant size, which is faster. */
static void copy_codes(uint8_t *to, const uint8_t *from, ptrdiff_t stride, int w, int rows)
{
    for (int y = 0; y < rows; y++, to += RF_TILE, from += stride) {
        if (w == RF_TILE)
            memcpy(to, from, RF_TILE);
        else
            memcpy(to, from, (size_t)w);
    }
}

void rf_encode_yuv_means(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                         struct rf_decode_job *job)
{
    const struct rf_yuv *yuv = f->yuv;
    const struct rf_yuv_codes *codes = &f->chroma.codes;
    const int x0 = tx * RF_TILE, y0 = ty * RF_TILE, c0 = y0 >> yuv->down;
    const int w = f->view->width - x0 < RF_TILE ? f->view->width - x0 : RF_TILE;
    const int h = f->view->height - y0 < RF_TILE ? f->view->height - y0 : RF_TILE;
    const int rows = (h + yuv->down) >> yuv->down;

    job->curve = &yuv->curve;
    job->down = yuv->down;
    /* The codes are those of the light before the pre-filter: a mean of many pixels may well be
     * what that made of one of them. */
    job->own_luma = f->light.channel[0] + y0 * f->view->stride + x0;
    job->own_chroma = f->chroma.light.at + c0 * f->view->stride + x0;
    job->stride = f->view->stride;
    copy_codes(job->y, codes->y + y0 * codes->y_stride + x0, codes->y_stride, w, h);
    copy_codes(job->uv, codes->uv + c0 * codes->uv_stride + x0, codes->uv_stride, w + w % 2, rows);
    repeat_edge(job, w, h);
    f->exec->kernels->decode(job);
    put(f, rect,
        &(struct codes){job->y + (rect.y0 - y0) * RF_TILE + rect.x0 - x0,
                        job->uv + ((rect.y0 - y0) >> yuv->down) * RF_TILE + rect.x0 - x0, RF_TILE,
                        RF_TILE});
}
