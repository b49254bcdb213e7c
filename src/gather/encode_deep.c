/* encode_deep.c: writes means to an output picture of more than 8 bits a channel. */
#include <stdlib.h>

#include "gather/frame.h"
#include "highlights/known.h"
#include "image/format.h"
#include "support/bayer.h"

/* Means of a part of the window, `scale` of which are Q14. */
struct means {
    struct rf_rect rect;
    const uint16_t *const *mean;
    const int16_t *const *more;
    ptrdiff_t pitch;
    int scale;
};

/* Whether a mean is the light of a pixel. */
static bool is_own(const struct rf_light_q12 *light, const struct means *m, ptrdiff_t at, int x,
                   int y)
{
    bool same = true;

    for (int c = 0; same && c < 3; c++)
        same = m->scale * m->mean[c][at] == 4 * light->channel[c][y * light->stride + x];
    return same;
}

/* Whether a pixel is in focus: what rays hit there has the light above white that it has itself
 * (highlights/known.h). */
static bool is_in_focus(const struct rf_frame *f, int x, int y)
{
    const int blur = rf_in_pixels(f->blur.at[y * f->blur.stride + x], f->blur.unit);

    return abs(blur) < RF_KNOWN_FROM;
}

/* The light of a pixel: its own, as exact as the photo has it, where nothing changed it. Returns
 * whether nothing did. */
static bool light_of(const struct rf_frame *f, const struct means *m, int x, int y, float light[3])
{
    const struct rf_deep *in = f->deep;
    const struct rf_light_q12 hit = rf_hit_light(f);
    const ptrdiff_t at = (y - m->rect.y0) * m->pitch + x - m->rect.x0;
    const bool same = in->on && (is_own(&f->light, m, at, x, y) ||
                                 (is_in_focus(f, x, y) && is_own(&hit, m, at, x, y)));

    if (same)
        rf_deep_light(in, f->view->x0 + x, f->view->y0 + y, light);
    else
        for (int c = 0; c < 3; c++)
            light[c] = (float)(256 * m->scale * m->mean[c][at] + (m->more ? m->more[c][at] : 0)) /
                       (256.0f * RF_MEAN_MAX);
    return same;
}

static void put_alpha(const struct rf_frame *f, uint8_t *to, int x, int y)
{
    const struct rf_deep *out = f->deep_out, *in = f->deep;
    const uint8_t *from;

    if (!in->on || in->channels < 4) {
        rf_deep_store_value(out, to, (float)f->alpha.at[y * f->alpha.stride + x] / 255);
        return;
    }
    from = rf_deep_pixel(in, f->view->x0 + x, f->view->y0 + y) + 3 * in->bytes;
    if (in->sample == out->sample)
        memcpy(to, from, (size_t)out->bytes);
    else
        rf_deep_store_value(out, to, rf_deep_value(in, from));
}

static void put_rgb(const struct rf_frame *f, const struct means *m, bool alike)
{
    const struct rf_deep *out = f->deep_out;

    for (int y = m->rect.y0; y < m->rect.y1; y++) {
        uint8_t *to = rf_deep_pixel(out, m->rect.x0 - f->region.x0, y - f->region.y0);

        for (int x = m->rect.x0; x < m->rect.x1; x++, to += out->channels * out->bytes) {
            float light[3];

            if (light_of(f, m, x, y, light) && alike)
                memcpy(to, rf_deep_pixel(f->deep, f->view->x0 + x, f->view->y0 + y),
                       3 * (size_t)out->bytes);
            else
                for (int c = 0; c < 3; c++)
                    rf_deep_store(out, to + c * out->bytes, light[c]);
            if (out->channels == 4)
                put_alpha(f, to + 3 * out->bytes, x, y);
        }
    }
}

/* Writes the pixels of the picture that share a sample of chroma, from (x, y) on. */
static void put_block(const struct rf_frame *f, const struct means *m, bool alike, int x, int y)
{
    const struct rf_deep *out = f->deep_out, *in = f->deep;
    const int x1 = x + 2 < m->rect.x1 ? x + 2 : m->rect.x1;
    const int y1 = y + 2 < m->rect.y1 ? y + 2 : m->rect.y1;
    uint8_t *const chroma = rf_deep_chroma(out, x - f->region.x0, y - f->region.y0);
    const float count = (float)((x1 - x) * (y1 - y));
    float sum[3] = {0, 0, 0}, light[3], value[3];
    bool all = alike;

    for (int v = y; v < y1; v++)
        for (int u = x; u < x1; u++) {
            uint8_t *const luma = rf_deep_luma(out, u - f->region.x0, v - f->region.y0);
            const bool same = light_of(f, m, u, v, light) && alike;

            for (int c = 0; c < 3; c++) {
                value[c] = rf_deep_value_of(out, light[c]);
                sum[c] += value[c];
            }
            if (same)
                memcpy(luma, rf_deep_luma(in, f->view->x0 + u, f->view->y0 + v), 2);
            else
                rf_deep_store_luma(out, luma, value);
            all &= same;
        }
    for (int c = 0; c < 3; c++)
        value[c] = sum[c] / count;
    if (all)
        memcpy(chroma, rf_deep_chroma(in, f->view->x0 + x, f->view->y0 + y), 4);
    else
        rf_deep_store_chroma(out, chroma, value);
}

void rf_encode_deep(const struct rf_frame *f, struct rf_rect rect, const uint16_t *const mean[3],
                    const int16_t *const *more, ptrdiff_t pitch, int scale)
{
    const struct means means = {rect, mean, more, pitch, scale};
    const bool alike = rf_deep_is_alike(f->deep_out, f->deep);

    if (!f->deep_out->yuv) {
        put_rgb(f, &means, alike);
        return;
    }
    for (int y = rect.y0; y < rect.y1; y += 2)
        for (int x = rect.x0; x < rect.x1; x += 2)
            put_block(f, &means, alike, x, y);
}

/* Codes are 255 * 64 steps here. A value that is a code is 64 of them, to within rounding, and
 * stays that code whatever the threshold. */
static uint8_t dithered(const struct rf_deep *curve, float light, int threshold)
{
    const float value = rf_deep_value_of(curve, light);
    const int steps = value < 1 ? (int)(value * (255 * 64) + 0.5f) : 255 * 64;

    return (uint8_t)((steps + threshold) >> 6);
}

void rf_encode_dithered(const struct rf_frame *f, struct rf_rect rect,
                        const uint16_t *const mean[3], ptrdiff_t pitch, int scale)
{
    const struct means means = {rect, mean, NULL, pitch, scale};
    const struct rf_order o = rf_order_of(f->out->format);

    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++) {
            const int threshold = rf_bayer(f->view->x0 + x, f->view->y0 + y, 3);
            uint8_t *const to = f->out->plane[0] + (y - f->region.y0) * f->out->stride[0] +
                                (ptrdiff_t)(x - f->region.x0) * o.bytes;
            float light[3];

            light_of(f, &means, x, y, light);
            to[o.r] = dithered(f->deep_out, light[0], threshold);
            to[o.g] = dithered(f->deep_out, light[1], threshold);
            to[o.b] = dithered(f->deep_out, light[2], threshold);
            if (o.a >= 0)
                to[o.a] = f->alpha.at[y * f->alpha.stride + x];
        }
}
