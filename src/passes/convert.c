#include "image/format.h"
#include "passes/planes.h"

#include <string.h>

/* A row of n pixels, read once; `bytes` is a constant. */
static inline void convert_row(uint16_t *restrict red, uint16_t *restrict green,
                               uint16_t *restrict blue, uint8_t *restrict alpha,
                               const uint8_t *restrict in, struct rf_order o, const int bytes,
                               const uint16_t *restrict to_light, int n)
{
    if (o.a < 0)
        memset(alpha, 255, (size_t)n);
    for (int x = 0; x < n; x++) {
        red[x] = to_light[in[x * bytes + o.r]];
        green[x] = to_light[in[x * bytes + o.g]];
        blue[x] = to_light[in[x * bytes + o.b]];
        if (o.a >= 0)
            alpha[x] = in[x * bytes + o.a];
    }
}

void rf_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo, int y0, int y1)
{
    const struct rf_order o = rf_order_of(photo->format);
    const uint16_t *to_light = r->transfer[r->blend].to_light;

    for (int y = y0; y < y1; y++) {
        const uint8_t *in = photo->plane[0] + y * photo->stride[0];
        uint16_t *red = r->light.channel[0] + y * r->view.stride;
        uint16_t *green = r->light.channel[1] + y * r->view.stride;
        uint16_t *blue = r->light.channel[2] + y * r->view.stride;
        uint8_t *alpha = r->alpha.at + y * r->alpha.stride;

        if (o.bytes == 3)
            convert_row(red, green, blue, alpha, in, o, 3, to_light, r->view.width);
        else
            convert_row(red, green, blue, alpha, in, o, 4, to_light, r->view.width);
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(&r->view, r->light.channel[c], r->view.stride, y0, y1);
}

void rf_reblend_rows(struct refocus_renderer *r, uint32_t from, uint32_t to, int y0, int y1)
{
    const uint8_t *to_code = r->transfer[from].to_code;
    const uint16_t *to_light = r->transfer[to].to_light;

    for (int c = 0; c < 3; c++) {
        for (int y = y0; y < y1; y++) {
            uint16_t *row = r->light.channel[c] + y * r->view.stride;

            for (int x = 0; x < r->view.width; x++)
                row[x] = to_light[to_code[4 * row[x]]];
        }
        rf_extend_rows(&r->view, r->light.channel[c], r->view.stride, y0, y1);
    }
}

void rf_disparity_rows(uint16_t *disparity, ptrdiff_t stride, const struct refocus_disparity *map,
                       int y0, int y1)
{
    for (int y = y0; y < y1; y++) {
        const uint8_t *in = (const uint8_t *)map->samples + y * map->stride;
        uint16_t *out = disparity + y * stride;

        if (map->bits == 16)
            memcpy(out, in, (size_t)map->width * 2);
        else
            for (int x = 0; x < map->width; x++)
                out[x] = (uint16_t)(in[x] * 257);
    }
}
