#include <refocus/render.h>

#include "depth/upsample.h"
#include "planes/format.h"
#include "planes/planes.h"
#include "planes/yuv.h"
#include "renderer/bands.h"
#include "renderer/layout.h"
#include "renderer/params.h"

struct job {
    struct refocus_renderer *r;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    const struct refocus_image *guide; /* of a photo of Y, U and V that edges are asked of */
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;
    struct refocus_renderer *r = job->r;

    if (r->yuv.on)
        rf_yuv_convert_rows(r, job->photo, job->guide, (uint8_t *)rf_scratch(r, worker),
                            rf_band_start(band), rf_band_end(r, band));
    else
        rf_convert_rows(r, job->photo, rf_band_start(band), rf_band_end(r, band));
}

static void disparity_band(void *context, int band, int worker)
{
    const struct job *job = context;

    (void)worker;
    rf_disparity_rows(job->r, job->map, rf_band_start(band), rf_band_end(job->r, band));
}

static uint16_t *scratch_of(void *context, int worker)
{
    return rf_scratch(context, worker);
}

/* A picture in the planes of what is seen, which are free until something is rendered. */
static struct refocus_image guide_in(const struct refocus_renderer *r)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, r->front.blur, r->width, r->height,
                                r->stride * (ptrdiff_t)sizeof(uint16_t));
}

/* The planes of the background layer are free until something is rendered. */
static void upsample(struct refocus_renderer *r, const struct job *job)
{
    const ptrdiff_t row = r->width + RF_BATCH_SPARE;
    struct rf_upsampler up = {
        .kernels = &r->kernels,
        .photo = job->guide ? job->guide : job->photo,
        .map = job->map,
        .columns = rf_upsample_samples(job->map->width, r->width),
        .rows = rf_upsample_samples(job->map->height, r->height),
        .coarse = r->behind.light[0],
        .coarse_stride = r->stride,
        .wide = r->behind.light[1],
        .wide_stride = r->stride,
        .raw = r->behind.light[2],
        .raw_stride = r->stride,
        .across = r->taps,
        .down = r->taps + r->width,
        .column = r->column + 2,
        .near_by = {r->near_by, r->near_by + row, r->near_by + 2 * row, r->near_by + 3 * row},
        .scratch = scratch_of,
        .context = r,
        .out = r->disparity,
        .out_stride = r->stride,
    };

    rf_upsample(&up, &r->pool);
}

int refocus_prepare(struct refocus_renderer *r, const struct refocus_image *photo,
                    const struct refocus_disparity *disparity)
{
    struct job job = {r, photo, disparity, NULL};
    struct refocus_image guide;
    bool same_size;

    if (!r)
        return REFOCUS_ERR_ARGUMENT;
    r->prepared = r->blurred = r->highlights_found = false;
    if (!rf_good_picture(photo) || !rf_good_map(disparity))
        return REFOCUS_ERR_ARGUMENT;
    if (photo->width > r->max_width || photo->height > r->max_height)
        return REFOCUS_ERR_SIZE;
    r->width = photo->width;
    r->height = photo->height;
    r->tiles_x = (r->width + RF_TILE - 1) / RF_TILE;
    r->tiles_y = (r->height + RF_TILE - 1) / RF_TILE;
    r->levels = rf_pyramid(r->level, r->width, r->height);
    rf_yuv_begin(r, photo);
    same_size = disparity->width == r->width && disparity->height == r->height;
    guide = guide_in(r);
    job.guide = r->yuv.on && !same_size ? &guide : NULL;
    rf_run_begin(r);
    rf_pool_run(&r->pool, convert_band, &job, rf_bands(r));
    if (same_size)
        rf_pool_run(&r->pool, disparity_band, &job, rf_bands(r));
    else
        upsample(r, &job);
    if (!rf_cancelled(r))
        rf_find_rims(r);
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->prepared = true;
    return REFOCUS_OK;
}
