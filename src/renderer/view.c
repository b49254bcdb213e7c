#include <refocus/render.h>

#include <stdlib.h>
#include <string.h>

#include "planes/format.h"
#include "renderer/renderer.h"

static void read_disparity(const struct refocus_renderer *r, int y, uint16_t *out)
{
    const struct rf_photo *photo = &r->photo[0];
    const struct refocus_disparity *map = &r->in_place.map;
    const uint8_t *row = (const uint8_t *)map->samples;

    if (!r->in_place.on)
        memcpy(out, photo->disparity + y * photo->stride, (size_t)photo->width * 2);
    else if (map->bits == 16)
        memcpy(out, row + y * map->stride, (size_t)photo->width * 2);
    else
        for (int x = 0; x < photo->width; x++)
            out[x] = (uint16_t)(row[y * map->stride + x] * 257);
}

enum { RUN = 256 };

/* Signed blurs of the last render in place of disparities, then without their signs. */
static void to_blur(const struct refocus_renderer *r, uint16_t *out, ptrdiff_t pitch)
{
    const struct rf_photo *photo = &r->photo[0];
    const uint32_t rims = r->last_rims ? photo->rims : 0;
    int16_t *blur = (int16_t *)out;
    uint16_t row[RUN];

    for (int y = 0; y < photo->height; y++) {
        for (int x = 0; x < photo->width; x += RUN) {
            const int n = photo->width - x < RUN ? photo->width - x : RUN;

            memcpy(row, out + y * pitch + x, (size_t)n * 2);
            rf_focus_row(&r->last_plan, blur + y * pitch + x, row, x, y, n);
        }
    }
    for (uint32_t i = 0; i < rims; i++) {
        const struct rf_rim *rim = &photo->rim[i];

        rf_focus_row(&r->last_plan, blur + rim->y * pitch + rim->x, &rim->disparity, rim->x,
                     rim->y, 1);
    }
    for (int y = 0; y < photo->height; y++)
        for (int x = 0; x < photo->width; x++)
            out[y * pitch + x] = (uint16_t)abs(blur[y * pitch + x]);
}

int refocus_get_view(struct refocus_renderer *r, uint32_t view, uint16_t *out,
                     ptrdiff_t stride)
{
    const struct rf_photo *photo;

    if (!r || !out || view > REFOCUS_VIEW_BLUR || stride % 2)
        return REFOCUS_ERR_ARGUMENT;
    if (!r->prepared || (view == REFOCUS_VIEW_BLUR && !r->blurred))
        return REFOCUS_ERR_STATE;
    photo = &r->photo[0];
    if (!rf_good_stride(stride, 2 * (ptrdiff_t)photo->width, photo->height))
        return REFOCUS_ERR_ARGUMENT;
    for (int y = 0; y < photo->height; y++)
        read_disparity(r, y, out + y * (stride / 2));
    if (view == REFOCUS_VIEW_BLUR)
        to_blur(r, out, stride / 2);
    return REFOCUS_OK;
}
