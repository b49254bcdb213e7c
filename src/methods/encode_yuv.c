#include "methods/method.h"
#include "planes/format.h"

#include <stdbool.h>
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
        put_luma(f, rect.x0, y, yuv->y + (size_t)y * f->r->width + rect.x0,
                 rect.x1 - rect.x0);
    for (int y = rect.y0; y < rect.y1; y += 1 << yuv->down)
        put_chroma(f, rect.x0, y, yuv->uv + (y >> yuv->down) * yuv->uv_stride + rect.x0,
                   (rect.x1 - rect.x0 + 1) / 2);
}

/* A tile's rows that share one of chroma: of means, of what the pixels themselves were given,
 * of their codes, and of the result. */
struct site_row {
    const uint16_t *mean[2], *own[2], *chroma, *own_chroma;
    const uint8_t *was[2], *uv_was;
    uint8_t y[2][RF_TILE], uv[RF_TILE];
};

static int limited(int mean)
{
    return mean > RF_MEAN_MAX ? RF_MEAN_MAX : mean;
}

/* Y of a pixel; one whose luminance and chroma did not change has the code that it had. */
static uint8_t luma_code(const struct rf_yuv_curve *curve, const struct site_row *row, int i,
                         int x, bool same_chroma, int excess)
{
    const int mean = row->mean[i][x];

    if (same_chroma && mean == 4 * row->own[i][x])
        return row->was[i][x];
    return curve->to_code[rf_clip_mean(limited(mean) - excess)];
}

/* Whether all pixels of a sample have the luminance that they had. */
static bool same_light(const struct site_row *row, int x, int next, int rows)
{
    for (int i = 0; i < rows; i++)
        if (row->mean[i][x] != 4 * row->own[i][x] ||
            row->mean[i][next] != 4 * row->own[i][next])
            return false;
    return true;
}

static void encode_site(const struct rf_yuv_curve *curve, struct site_row *row, int x, int next,
                        int rows)
{
    const int lower = rows - 1;
    const int light = (limited(row->mean[0][x]) + limited(row->mean[0][next]) +
                       limited(row->mean[lower][x]) + limited(row->mean[lower][next]) + 2) >> 2;
    const struct rf_chroma_code code =
        rf_chroma_code(curve, light, row->chroma[x], row->chroma[x + 1]);
    const bool same_chroma = row->chroma[x] == 4 * row->own_chroma[x] &&
                             row->chroma[x + 1] == 4 * row->own_chroma[x + 1];
    const bool same = same_chroma && same_light(row, x, next, rows);

    for (int i = 0; i < rows; i++) {
        row->y[i][x] = luma_code(curve, row, i, x, same_chroma, code.excess);
        row->y[i][next] = luma_code(curve, row, i, next, same_chroma, code.excess);
    }
    row->uv[x] = same ? row->uv_was[x] : code.u;
    row->uv[x + 1] = same ? row->uv_was[x + 1] : code.v;
}

void rf_encode_yuv_means(const struct rf_frame *f, struct rf_rect rect,
                         const uint16_t luma[RF_TILE * RF_TILE],
                         const uint16_t chroma[RF_TILE * RF_TILE])
{
    const struct refocus_renderer *r = f->r;
    const struct rf_yuv *yuv = &r->yuv;
    const int x0 = rect.x0 % RF_TILE, w = rect.x1 - rect.x0;

    for (int y = rect.y0; y < rect.y1; y += 1 << yuv->down) {
        const int cy = y >> yuv->down, rows = yuv->down && y + 1 < rect.y1 ? 2 : 1;
        struct site_row row = {
            .chroma = chroma + (y % RF_TILE >> yuv->down) * RF_TILE + x0,
            .own_chroma = yuv->smooth + cy * r->stride + rect.x0,
            .uv_was = yuv->uv + cy * yuv->uv_stride + rect.x0,
        };

        for (int i = 0; i < rows; i++) {
            row.mean[i] = luma + (y + i) % RF_TILE * RF_TILE + x0;
            row.own[i] = r->smooth[0] + (y + i) * r->stride + rect.x0;
            row.was[i] = yuv->y + (size_t)(y + i) * r->width + rect.x0;
        }
        for (int x = 0; x < w; x += 2)
            encode_site(&yuv->curve, &row, x, x + 1 < w ? x + 1 : x, rows);
        for (int i = 0; i < rows; i++)
            put_luma(f, rect.x0, y + i, row.y[i], w);
        put_chroma(f, rect.x0, y, row.uv, (w + 1) / 2);
    }
}
