#include "renderer/layout.h"
#include "renderer/renderer.h"

/* The planes of a group of a photo's shape, from pixel `at` of the photo on. */
static uint16_t *plane(const struct rf_photo *photo, uint16_t *group, int i, ptrdiff_t at)
{
    return group + photo->pad * (photo->stride + 1) + i * photo->pitch + at;
}

void rf_use(struct refocus_renderer *r, int number, struct rf_rect window)
{
    const struct rf_photo *photo = &r->photo[number];
    const ptrdiff_t at = window.y0 * photo->stride + window.x0;

    r->used = number;
    r->origin_x = window.x0;
    r->origin_y = window.y0;
    r->width = window.x1 - window.x0;
    r->height = window.y1 - window.y0;
    r->pad = photo->pad;
    r->stride = photo->stride;
    r->pitch = photo->pitch;
    r->disparity = photo->disparity + at;
    r->alpha = photo->alpha + (ptrdiff_t)window.y0 * photo->width + window.x0;
    r->alpha_stride = photo->width;
    r->front.blur = (int16_t *)plane(photo, r->seen_group, 0, at);
    r->behind.blur = (int16_t *)plane(photo, r->behind_group, 0, at);
    for (int c = 0; c < 3; c++) {
        r->front.light[c] = photo->light[c] + at;
        r->smooth[c] = plane(photo, r->seen_group, 1 + c, at);
        r->behind.light[c] = plane(photo, r->behind_group, 1 + c, at);
    }
    r->tiles_x = (r->width + RF_TILE - 1) / RF_TILE;
    r->tiles_y = (r->height + RF_TILE - 1) / RF_TILE;
    r->levels = rf_pyramid(r->level, r->width, r->height);
}
