#include "finish/finish.h"

#include "methods/method.h"

void rf_finish_begin(struct rf_frame *f)
{
    if (f->finish_ready)
        return;
    if (f->stars)
        rf_find_stars(f);
    if (f->grain)
        rf_measure_grain(f);
    f->finish_ready = true;
}

void rf_finish_rect(const struct rf_frame *f, struct rf_rect rect)
{
    if (f->stars)
        rf_add_stars(f, rect);
    if (f->grain)
        rf_add_grain(f, rect);
}

int rf_disparity_at(const struct refocus_renderer *r, int x, int y)
{
    const struct rf_photo *photo = &r->photo[r->used];
    const struct refocus_disparity *map = &r->in_place.map;
    const uint8_t *row;

    if (!r->in_place.on)
        return photo->disparity[y * photo->stride + x];
    row = (const uint8_t *)map->samples + y * map->stride;
    return map->bits == 8 ? row[x] * 257 : ((const uint16_t *)(const void *)row)[x];
}

int rf_blur_at(const struct rf_frame *f, int x, int y)
{
    const uint16_t disparity = (uint16_t)rf_disparity_at(f->r, x, y);
    int16_t blur;

    rf_focus_row(&f->plan, &blur, &disparity, x, y, 1);
    return blur;
}
