#include "methods/method.h"
#include "planes/format.h"

#include <string.h>

/* Where samples of a row of the result are. */
struct row {
    uint8_t *first;
    int step; /* bytes */
};

static uint8_t *row_of(const struct rf_frame *f, int plane, int row)
{
    return f->out->plane[plane] + row * f->out->stride[plane];
}

/* Of Y (i = 0), U or V from column x of the picture on. */
static struct row samples(const struct rf_frame *f, int i, int x, int y)
{
    const bool chroma = i > 0;
    const int down = chroma ? f->r->yuv.down : 0;
    const int row = (y - f->region.y0) >> down, column = (x - f->region.x0) >> chroma;

    switch (f->out->format) {
    case REFOCUS_FORMAT_YUYV:
        return (struct row){row_of(f, 0, row) + (chroma ? 4 * column + 2 * i - 1 : 2 * column),
                            chroma ? 4 : 2};
    case REFOCUS_FORMAT_I420:
        return (struct row){row_of(f, i, row) + column, 1};
    default:
        if (!chroma)
            return (struct row){row_of(f, 0, row) + column, 1};
        return (struct row){row_of(f, 1, row) + 2 * column +
                                ((i == 2) ^ (f->out->format == REFOCUS_FORMAT_NV21)),
                            2};
    }
}

/* A row of the result from codes that follow each other. */
static void put(struct row out, const uint8_t *code, int n)
{
    if (out.step == 1)
        memcpy(out.first, code, (size_t)n);
    else
        for (int x = 0; x < n; x++)
            out.first[x * out.step] = code[x];
}

/* n codes of Y; the pixel that YUYV has more than an odd row is that beside it. */
static void put_luma(const struct rf_frame *f, int x, int y, const uint8_t *code, int n)
{
    const struct row out = samples(f, 0, x, y);

    put(out, code, n);
    if (out.step == 2 && n % 2)
        out.first[2 * n] = code[n - 1];
}

/* n pairs of U and V. */
static void put_chroma(const struct rf_frame *f, int x, int y, const uint8_t *uv, int n)
{
    const struct row u = samples(f, 1, x, y), v = samples(f, 2, x, y);

    if (f->out->format == REFOCUS_FORMAT_NV12) {
        memcpy(u.first, uv, 2 * (size_t)n);
        return;
    }
    for (int i = 0; i < n; i++) {
        u.first[i * u.step] = uv[2 * i];
        v.first[i * v.step] = uv[2 * i + 1];
    }
}

void rf_copy_yuv_tile(const struct rf_frame *f, struct rf_rect rect)
{
    const struct rf_yuv *yuv = &f->r->yuv;

    for (int y = rect.y0; y < rect.y1; y++)
        put_luma(f, rect.x0, y, yuv->y + y * yuv->y_stride + rect.x0,
                 rect.x1 - rect.x0);
    for (int y = rect.y0; y < rect.y1; y += 1 << yuv->down)
        put_chroma(f, rect.x0, y, yuv->uv + (y >> yuv->down) * yuv->uv_stride + rect.x0,
                   (rect.x1 - rect.x0 + 1) / 2);
}

/* Repeat what is there over the pixel beside an odd edge, which shares its sample. */
static void repeat_edge(struct rf_decode_job *job, int w, int h)
{
    if (w % 2)
        for (int y = 0; y < h; y++)
            job->luma[y * RF_TILE + w] = job->luma[y * RF_TILE + w - 1];
    if (job->down && h % 2)
        memcpy(job->luma + h * RF_TILE, job->luma + (h - 1) * RF_TILE,
               RF_TILE * sizeof job->luma[0]);
}

void rf_encode_yuv_means(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                         struct rf_decode_job *job)
{
    const struct refocus_renderer *r = f->r;
    const struct rf_yuv *yuv = &r->yuv;
    const int x0 = tx * RF_TILE, y0 = ty * RF_TILE, c0 = y0 >> yuv->down;
    const int w = r->width - x0 < RF_TILE ? r->width - x0 : RF_TILE;
    const int h = r->height - y0 < RF_TILE ? r->height - y0 : RF_TILE;
    const int rows = (h + yuv->down) >> yuv->down;

    job->curve = &yuv->curve;
    job->down = yuv->down;
    job->own_luma = r->smooth[0] + y0 * r->stride + x0;
    job->own_chroma = yuv->smooth + c0 * r->stride + x0;
    job->stride = r->stride;
    for (int y = 0; y < h; y++)
        memcpy(job->y + y * RF_TILE, yuv->y + (y0 + y) * yuv->y_stride + x0, (size_t)w);
    for (int y = 0; y < rows; y++)
        memcpy(job->uv + y * RF_TILE, yuv->uv + (c0 + y) * yuv->uv_stride + x0,
               (size_t)(w + w % 2));
    repeat_edge(job, w, h);
    r->kernels.decode(job);
    for (int y = rect.y0; y < rect.y1; y++)
        put_luma(f, rect.x0, y, job->y + (y - y0) * RF_TILE + rect.x0 - x0, rect.x1 - rect.x0);
    for (int y = rect.y0; y < rect.y1; y += 1 << yuv->down)
        put_chroma(f, rect.x0, y, job->uv + ((y - y0) >> yuv->down) * RF_TILE + rect.x0 - x0,
                   (rect.x1 - rect.x0 + 1) / 2);
}
