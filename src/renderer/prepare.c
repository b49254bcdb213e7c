#include <refocus/render.h>

#include <string.h>

#include "depth/dequantise.h"
#include "depth/upsample.h"
#include "planes/format.h"
#include "planes/planes.h"
#include "planes/yuv.h"
#include "renderer/bands.h"
#include "renderer/layout.h"
#include "renderer/load.h"
#include "renderer/params.h"

/* The planes of blurs, of pre-filtered light and of the background layer are free until
 * something is rendered. */
static void upsample(struct refocus_renderer *r, const struct refocus_image *photo,
                     const struct refocus_disparity *map)
{
    struct rf_upsampler up = {
        .kernels = &r->kernels,
        .photo = photo,
        .map = map,
        .columns = rf_upsample_samples(map->width, r->width),
        .rows = rf_upsample_samples(map->height, r->height),
        .coarse = r->behind.light[0],
        .coarse_stride = r->stride,
        .wide = r->behind.light[1],
        .wide_stride = r->stride,
        .settled = r->behind.light[2],
        .settled_stride = r->stride,
        .across = r->taps,
        .down = r->taps + r->width,
        .colour = {(uint8_t *)r->smooth[0], (uint8_t *)r->smooth[1], (uint8_t *)r->smooth[2]},
        .colour_stride = r->stride * (ptrdiff_t)sizeof *r->smooth[0],
        .sure = (uint8_t *)r->front.blur,
        .sure_stride = r->stride * (ptrdiff_t)sizeof *r->front.blur,
        .unsure = (uint16_t *)r->front.blur + (r->width + 1) / 2, /* behind `sure` */
        .unsure_stride = r->stride,
        .span = r->spans,
        .out = r->disparity,
        .out_stride = r->stride,
    };

    rf_upsample(&up, &r->pool);
}

static void take_in(struct refocus_renderer *r, const struct refocus_image *photo,
                    const struct refocus_disparity *disparity)
{
    const bool same_size = disparity->width == r->width && disparity->height == r->height;
    const struct refocus_image guide = r->yuv.on ? rf_yuv_guide(r) : *photo;

    rf_load_light(r, photo, same_size ? NULL : &guide);
    if (same_size)
        rf_load_disparity(r, disparity, rf_code_step(disparity), 0, 0);
    else
        upsample(r, &guide, disparity);
    if (!rf_cancelled(r))
        rf_find_rims(r, rf_whole(r));
}

int refocus_prepare(struct refocus_renderer *r, const struct refocus_image *photo,
                    const struct refocus_disparity *disparity)
{
    struct rf_photo *own;

    if (!r)
        return REFOCUS_ERR_ARGUMENT;
    r->prepared = r->blurred = false;
    memset(&r->made, 0, sizeof r->made);
    if (!rf_good_picture(photo) || !rf_good_map(disparity))
        return REFOCUS_ERR_ARGUMENT;
    if (photo->width > r->max_width || photo->height > r->max_height)
        return REFOCUS_ERR_SIZE;
    if (r->in_place.on && (disparity->width != photo->width || disparity->height != photo->height ||
                           refocus_format_is_yuv(photo->format)))
        return REFOCUS_ERR_UNSUPPORTED;
    own = &r->photo;
    own->width = photo->width;
    own->height = photo->height;
    own->highlights_blend = own->thin.blend = RF_NO_BLEND;
    own->rims = 0;
    r->blend = REFOCUS_BLEND_LINEAR; /* that rims are found in, whatever came before */
    rf_yuv_begin(r, photo);
    rf_run_begin(r);
    if (r->in_place.on) {
        r->in_place.photo = *photo;
        r->in_place.map = *disparity;
        r->in_place.code_step = rf_code_step(disparity);
        rf_find_rims_in_blocks(r);
    } else {
        rf_use(r, rf_whole(r));
        memset(own->band_blend, REFOCUS_BLEND_LINEAR, (size_t)rf_bands(r));
        take_in(r, photo, disparity);
    }
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->prepared = true;
    return REFOCUS_OK;
}
