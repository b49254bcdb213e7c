#include "renderer/layout.h"
#include "planes/yuv.h"
#include "renderer/renderer.h"
#include "support/compare.h"

/* Pixel (0, 0) of the window in a group of planes of a photo; see rf_use(). */
static uint16_t *origin(const struct refocus_renderer *r, const struct rf_photo *photo,
                        uint16_t *group)
{
    if (r->in_place.on) /* the border, or where the photo goes on nothing but spare rows */
        return group + (RF_SPARE_ROWS + r->border.y0) * photo->stride + r->border.x0;
    return group + (photo->pad + r->origin_y) * photo->stride + photo->pad + r->origin_x;
}

static void place_planes(struct refocus_renderer *r, const struct rf_photo *photo)
{
    uint16_t *const light = origin(r, photo, photo->group);
    uint16_t *const seen = origin(r, photo, r->seen_group);
    uint16_t *const behind = origin(r, photo, r->behind_group);

    for (int c = 0; c < 3; c++) {
        r->front.light[c] = light + c * photo->pitch;
        r->smooth[c] = seen + (1 + c) * photo->pitch;
        r->behind.light[c] = behind + (1 + c) * photo->pitch;
    }
    r->disparity = light + 3 * photo->pitch;
    r->front.blur = (int16_t *)seen;
    r->behind.blur = (int16_t *)behind;
}

void rf_use(struct refocus_renderer *r, struct rf_rect window)
{
    const struct rf_photo *photo = &r->photo;
    const struct rf_rect *const beyond = &r->in_place.beyond;
    const int pad = photo->pad;

    r->origin_x = window.x0;
    r->origin_y = window.y0;
    r->width = window.x1 - window.x0;
    r->height = window.y1 - window.y0;
    r->pad = pad;
    r->stride = photo->stride;
    r->pitch = photo->pitch;
    r->border = (struct rf_rect){pad, pad, pad, pad + RF_TILE};
    r->alpha = photo->alpha + (ptrdiff_t)window.y0 * photo->width + window.x0;
    r->alpha_stride = photo->width;
    if (r->in_place.on) {
        r->border = (struct rf_rect){
            window.x0 ? 0 : rf_smaller(pad, beyond->x0),
            window.y0 ? 0 : rf_smaller(pad, beyond->y0),
            window.x1 < photo->width ? 0 : rf_smaller(pad, beyond->x1),
            window.y1 < photo->height ? 0 : rf_smaller(pad, beyond->y1) + RF_TILE,
        };
        r->alpha = photo->alpha;
        r->alpha_stride = rf_block_side(&r->in_place);
    }
    place_planes(r, photo);
    rf_yuv_use(r);
    r->tiles_x = (r->width + RF_TILE - 1) / RF_TILE;
    r->tiles_y = (r->height + RF_TILE - 1) / RF_TILE;
    r->levels = rf_pyramid(r->level, r->width, r->height);
}
