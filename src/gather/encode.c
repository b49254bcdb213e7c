/* encode.c: writes the means of a tile to the output picture as 8-bit codes of R, G and B. */
#include "gather/fine_means.h"
#include "gather/frame.h"
#include "image/format.h"

static uint8_t *pixel(const struct rf_frame *f, int bytes, int x, int y)
{
    return f->out->plane[0] + (y - f->region.y0) * f->out->stride[0] +
           (ptrdiff_t)(x - f->region.x0) * bytes;
}

void rf_expect_tile(const struct rf_frame *f, struct rf_rect rect)
{
    const int bytes = rf_order_of(f->out->format).bytes;

    for (int y = rect.y0; y < rect.y1; y++) {
        const uint8_t *out = pixel(f, bytes, rect.x0, y);

        __builtin_prefetch(out, 1);
        __builtin_prefetch(out + (rect.x1 - rect.x0) * bytes - 1, 1);
    }
}

/* Writes one channel of a row of n pixels. `bytes`, from pixel to pixel, is a constant where this
 * is inlined, and so is the length of whole rows, which lets the compiler unroll them. */
static inline void encode_channel(uint8_t *restrict out, const int bytes,
                                  const uint16_t *restrict mean, const uint8_t *restrict to_code,
                                  int n)
{
    if (n != RF_TILE) {
        for (int x = 0; x < n; x++)
            out[x * bytes] = to_code[mean[x]];
        return;
    }
#pragma GCC unroll 16
    for (int x = 0; x < RF_TILE; x++)
        out[x * bytes] = to_code[mean[x]];
}

static void encode(const struct rf_frame *f, struct rf_rect rect, const uint16_t *const mean[3],
                   int pitch)
{
    const struct rf_order o = rf_order_of(f->out->format);
    const uint8_t *const to_code = f->transfer->to_code;
    const int to[3] = {o.r, o.g, o.b}, n = rect.x1 - rect.x0, rows = rect.y1 - rect.y0;
    const uint8_t *alpha = f->alpha.at + rect.y0 * f->alpha.stride + rect.x0;
    uint8_t *out = pixel(f, o.bytes, rect.x0, rect.y0);

    for (int c = 0; c < 3; c++)
        for (int y = 0; y < rows; y++)
            if (o.bytes == 3)
                encode_channel(out + y * f->out->stride[0] + to[c], 3, mean[c] + y * pitch, to_code,
                               n);
            else
                encode_channel(out + y * f->out->stride[0] + to[c], 4, mean[c] + y * pitch, to_code,
                               n);
    for (int y = 0; o.a >= 0 && y < rows; y++)
        for (int x = 0; x < n; x++)
            out[y * f->out->stride[0] + x * o.bytes + o.a] = alpha[y * f->alpha.stride + x];
}

void rf_encode_rows(const struct rf_frame *f, struct rf_rect rect, const uint16_t *const mean[3],
                    int pitch)
{
    if (f->deep_out->on)
        rf_encode_deep(f, rect, mean, NULL, pitch, 1);
    else if (f->dither)
        rf_encode_dithered(f, rect, mean, pitch, 1);
    else
        encode(f, rect, mean, pitch);
}

static void encode_tile(const struct rf_frame *f, struct rf_rect rect,
                        uint16_t mean[3][RF_TILE * RF_TILE])
{
    const int at = rect.y0 % RF_TILE * RF_TILE + rect.x0 % RF_TILE;

    rf_encode_rows(f, rect, (const uint16_t *const[3]){mean[0] + at, mean[1] + at, mean[2] + at},
                   RF_TILE);
}

void rf_encode_means(const struct rf_frame *f, struct rf_rect rect,
                     uint16_t mean[3][RF_TILE * RF_TILE])
{
    if (f->bright && !f->deep_out->on && !f->dither) /* highlights make means above white */
        f->exec->kernels->clamp_row(mean[0], RF_MEAN_MAX, 3 * RF_TILE * RF_TILE);
    encode_tile(f, rect, mean);
}

void rf_encode_fine(const struct rf_frame *f, struct rf_rect rect,
                    uint16_t mean[3][RF_TILE * RF_TILE], struct rf_fine_means *fine)
{
    const int at = rect.y0 % RF_TILE * RF_TILE + rect.x0 % RF_TILE;

    rf_fine_means_forget(fine, mean);
    rf_encode_deep(
        f, rect, (const uint16_t *const[3]){mean[0] + at, mean[1] + at, mean[2] + at},
        (const int16_t *const[3]){fine->more[0] + at, fine->more[1] + at, fine->more[2] + at},
        RF_TILE, 1);
}

void rf_encode_tile(const struct rf_frame *f, struct rf_rect rect, const struct rf_sums *sums)
{
    uint16_t mean[3][RF_TILE * RF_TILE];

    for (int c = 0; c < 3; c++)
        for (int y = rect.y0; y < rect.y1; y++)
            for (int x = rect.x0; x < rect.x1; x++) {
                const int at = y % RF_TILE * RF_TILE + x % RF_TILE;
                const uint64_t w = sums->weight[at], v = (4 * sums->light[c][at] + w / 2) / w;

                mean[c][at] = (uint16_t)(v < RF_MEAN_MAX ? v : RF_MEAN_MAX);
            }
    encode_tile(f, rect, mean);
}

void rf_copy_tile(const struct rf_frame *f, struct rf_rect rect)
{
    const struct rf_order o = rf_order_of(f->out->format);
    const uint8_t *to_code = f->transfer->to_code;
    const ptrdiff_t first = rect.y0 * f->light.stride + rect.x0;
    const uint16_t *const light[3] = {f->light.channel[0] + first, f->light.channel[1] + first,
                                      f->light.channel[2] + first};

    if (f->deep_out->on) {
        rf_encode_deep(f, rect, light, NULL, f->light.stride, 4);
        return;
    }
    if (f->dither) {
        rf_encode_dithered(f, rect, light, f->light.stride, 4);
        return;
    }
    for (int y = rect.y0; y < rect.y1; y++) {
        const uint8_t *alpha = f->alpha.at + y * f->alpha.stride;
        uint8_t *out = pixel(f, o.bytes, rect.x0, y);

        for (int x = rect.x0; x < rect.x1; x++, out += o.bytes) {
            const ptrdiff_t at = (y - rect.y0) * f->light.stride + x - rect.x0;

            out[o.r] = to_code[4 * light[0][at]];
            out[o.g] = to_code[4 * light[1][at]];
            out[o.b] = to_code[4 * light[2][at]];
            if (o.a >= 0)
                out[o.a] = alpha[x];
        }
    }
}

void rf_write_pixel(const struct rf_frame *f, int x, int y, const uint8_t rgb[3])
{
    const struct rf_order o = rf_order_of(f->out->format);
    uint8_t *out = pixel(f, o.bytes, x, y);

    out[o.r] = rgb[0];
    out[o.g] = rgb[1];
    out[o.b] = rgb[2];
    if (o.a >= 0)
        out[o.a] = f->alpha.at[y * f->alpha.stride + x];
}
