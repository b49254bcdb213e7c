#include "finish/finish.h"

#include <string.h>

#include "depth/dequantise.h"
#include "gather/frame.h"
#include "renderer/renderer.h"

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

static void copy_disparities(const struct refocus_renderer *r, int x, int y, int width, int height,
                             uint16_t *out)
{
    const struct rf_photo *photo = &r->photo;
    const struct rf_in_place *in_place = &r->in_place;

    if (in_place->on)
        rf_dequantised_patch(r->exec.kernels, &in_place->map, in_place->code_step, x, y, width,
                             height, out);
    for (int v = 0; v < height && !in_place->on; v++)
        memcpy(out + v * width, photo->disparity + (y + v) * photo->stride + x,
               (size_t)width * sizeof *out);
}

void rf_blurs_at(const struct rf_frame *f, int x, int y, int width, int height, int16_t *blur)
{
    uint16_t disparity[RF_DEQUANTISE_PATCH * RF_DEQUANTISE_PATCH];

    copy_disparities(f->r, x, y, width, height, disparity);
    for (int v = 0; v < height; v++)
        rf_focus_row(&f->plan, blur + v * width, disparity + v * width, x, y + v, width);
}
