#include "planes/format.h"
#include "planes/planes.h"

#include <string.h>

void rf_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo, int y0,
                     int y1)
{
    const struct rf_order o = rf_order_of(photo->format);
    const uint16_t *to_light = r->transfer[r->blend].to_light;

    for (int y = y0; y < y1; y++) {
        const uint8_t *in = photo->plane[0] + y * photo->stride[0];
        uint16_t *red = r->front.light[0] + y * r->stride;
        uint16_t *green = r->front.light[1] + y * r->stride;
        uint16_t *blue = r->front.light[2] + y * r->stride;
        uint8_t *alpha = r->alpha + y * r->alpha_stride;

        for (int x = 0; x < r->width; x++, in += o.bytes) {
            red[x] = to_light[in[o.r]];
            green[x] = to_light[in[o.g]];
            blue[x] = to_light[in[o.b]];
            alpha[x] = o.a < 0 ? 255 : in[o.a];
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, r->front.light[c], y0, y1);
}

void rf_reblend_rows(struct refocus_renderer *r, uint32_t from, uint32_t to, int y0, int y1)
{
    const uint8_t *to_code = r->transfer[from].to_code;
    const uint16_t *to_light = r->transfer[to].to_light;

    for (int c = 0; c < 3; c++) {
        for (int y = y0; y < y1; y++) {
            uint16_t *row = r->front.light[c] + y * r->stride;

            for (int x = 0; x < r->width; x++)
                row[x] = to_light[to_code[4 * row[x]]];
        }
        rf_extend_rows(r, r->front.light[c], y0, y1);
    }
}

void rf_disparity_rows(struct refocus_renderer *r, const struct refocus_disparity *map,
                       int y0, int y1)
{
    for (int y = y0; y < y1; y++) {
        const uint8_t *in = (const uint8_t *)map->samples + y * map->stride;
        uint16_t *out = r->disparity + y * r->stride;

        if (map->bits == 16)
            memcpy(out, in, (size_t)r->width * 2);
        else
            for (int x = 0; x < r->width; x++)
                out[x] = (uint16_t)(in[x] * 257);
    }
}
