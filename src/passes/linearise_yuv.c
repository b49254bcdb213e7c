/* linearise_yuv.c: turns the codes of a photo of Y, U and V into luminance and chroma. */
#include "passes/linearise_yuv.h"

#include <string.h>

#include "image/border.h"
#include "image/format.h"
#include "kernels/kernels.h"

/* Converts row cy of chroma, and the rows of luma that share it, from the codes that are kept. The
 * pixel beside an odd edge, which planes have room for, is made of scratch: rows of codes have
 * none. */
static void convert_codes(const struct rf_executor *exec, const struct rf_viewport *view,
                          const struct rf_linearise_yuv *pass, uint8_t *scratch, int cy)
{
    const struct rf_yuv_codes codes = pass->codes;
    const int down = pass->size.down, w = view->width, y = cy << down;
    const bool two = down && y + 1 < view->height;
    const uint8_t *luma[2] = {codes.y + y * codes.y_stride, codes.y + (y + two) * codes.y_stride};
    uint16_t *const out[2] = {pass->light.channel[0] + y * pass->light.stride,
                              pass->light.channel[0] + (y + two) * pass->light.stride};

    if (w % 2) {
        for (int i = 0; i < 2; i++) {
            uint8_t *row = scratch + i * (w + 1);

            memcpy(row, luma[i], (size_t)w);
            row[w] = row[w - 1];
            luma[i] = row;
        }
    }
    exec->kernels->encode(out, pass->chroma.at + cy * pass->chroma.stride, luma,
                          codes.uv + cy * codes.uv_stride, pass->curve, pass->size.width);
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
 * uncached, and slow to read in pieces. Only those that lie in between others take a second copy,
 * from `scratch`.
 */
static void keep_420(const struct rf_linearise_yuv *pass, uint8_t *scratch, int cy)
{
    const struct refocus_image *photo = pass->photo;
    const int w = pass->size.width;
    uint8_t *uv = pass->codes.uv + cy * pass->codes.uv_stride;

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

static void keep_422(const struct rf_linearise_yuv *pass, uint8_t *scratch, int row, int w)
{
    const int even = w & ~1;
    uint8_t *y = pass->codes.y + row * pass->codes.y_stride;
    uint8_t *uv = pass->codes.uv + row * pass->codes.uv_stride;

    memcpy(scratch, pass->photo->plane[0] + row * pass->photo->stride[0],
           4 * (size_t)pass->size.width);
    split(y, uv, scratch, even);
    if (even < w) {
        y[even] = scratch[2 * even];
        uv[even] = scratch[2 * even + 1];
        uv[w] = scratch[2 * even + 3];
    }
}

void rf_reblend_yuv_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                         const struct rf_linearise_yuv *pass, int y0, int y1, int worker)
{
    const int down = pass->size.down, c0 = y0 >> down, c1 = rf_chroma_end(down, y1);
    const int end = c1 << down;
    uint8_t *const scratch = (uint8_t *)rf_scratch(exec, worker);

    for (int cy = c0; cy < c1; cy++)
        convert_codes(exec, view, pass, scratch, cy);
    rf_extend_rows(view, pass->light.channel[0], pass->light.stride, c0 << down,
                   end < view->height ? end : view->height);
    rf_extend_chroma(view, &pass->size, pass->chroma.at, pass->chroma.stride, c0, c1);
}

struct job {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_linearise_yuv *pass;
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;
    const struct rf_linearise_yuv *pass = job->pass;
    const struct refocus_image *photo = pass->photo, *guide = pass->guide;
    const int y0 = rf_band_start(band), y1 = rf_band_end(job->view, band);
    const int down = pass->size.down, c1 = rf_chroma_end(down, y1), w = job->view->width;
    uint8_t *const scratch = (uint8_t *)rf_scratch(job->exec, worker);

    if (down)
        for (int y = y0; y < y1; y++)
            memcpy(pass->codes.y + y * pass->codes.y_stride, photo->plane[0] + y * photo->stride[0],
                   (size_t)w);
    for (int cy = y0 >> down; cy < c1; cy++) {
        if (down)
            keep_420(pass, scratch, cy);
        else
            keep_422(pass, scratch, cy, w);
    }
    rf_reblend_yuv_rows(job->exec, job->view, pass, y0, y1, worker);
    for (int y = y0; guide && y < y1; y++)
        job->exec->kernels->guide(
            guide->plane[0] + y * guide->stride[0], pass->codes.y + y * pass->codes.y_stride,
            pass->codes.uv + (y >> down) * pass->codes.uv_stride, pass->curve, w);
}

void rf_linearise_yuv(const struct rf_executor *exec, const struct rf_viewport *view,
                      const struct rf_linearise_yuv *pass)
{
    struct job job = {exec, view, pass};

    rf_pool_run(exec->pool, convert_band, &job, rf_bands(view));
}
