/* look.c: what is laid over the finished picture, and what its parts have in common. */
#include "look/look.h"

#include <string.h>

#include "depth/dequantise.h"
#include "image/format.h"

void rf_look_begin(const struct rf_look *look)
{
    if (look->has_stars)
        rf_find_stars(look);
    if (look->has_grain)
        rf_measure_grain(look);
}

void rf_look_over(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect)
{
    if (look->has_stars)
        rf_add_stars(look, canvas, rect);
    if (look->has_grain)
        rf_add_grain(look, canvas, rect);
}

static void copy_disparities(const struct rf_look *look, int x, int y, int width, int height,
                             uint16_t *out)
{
    const struct rf_photo_source *photo = &look->photo;
    const struct rf_disparity_q16 *d = &photo->disparity;

    if (!rf_has_planes(photo)) {
        rf_dequantised_patch(look->exec->kernels, photo->map, photo->code_step, x, y, width, height,
                             out);
        return;
    }
    for (int v = 0; v < height; v++)
        memcpy(out + v * width, d->at + (y + v) * d->stride + x, (size_t)width * sizeof *out);
}

void rf_blurs_at(const struct rf_look *look, int x, int y, int width, int height, int16_t *blur)
{
    uint16_t disparity[RF_DEQUANTISE_PATCH * RF_DEQUANTISE_PATCH];

    copy_disparities(look, x, y, width, height, disparity);
    for (int v = 0; v < height; v++)
        rf_focus_row(look->plan, blur + v * width, disparity + v * width, x, y + v, width);
}

void rf_codes_at(const struct rf_canvas *canvas, int x, int y, uint8_t *code[3])
{
    const struct rf_order o = rf_order_of(canvas->out->format);
    uint8_t *out = canvas->out->plane[0] + (y - canvas->region.y0) * canvas->out->stride[0] +
                   (ptrdiff_t)(x - canvas->region.x0) * o.bytes;

    code[0] = out + o.r;
    code[1] = out + o.g;
    code[2] = out + o.b;
}
