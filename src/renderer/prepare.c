#include <refocus/render.h>

#include <string.h>

#include "depth/upsample.h"
#include "planes/format.h"
#include "planes/planes.h"
#include "renderer/bands.h"
#include "renderer/layout.h"
#include "renderer/params.h"
#include "renderer/reduce.h"

struct job {
    struct refocus_renderer *r;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;

    (void)worker;
    rf_convert_rows(job->r, job->photo, rf_band_start(band), rf_band_end(job->r, band));
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

/* The planes of the background layer are free until something is rendered. */
static void upsample(struct refocus_renderer *r, const struct job *job)
{
    const ptrdiff_t row = r->width + RF_BATCH_SPARE;
    struct rf_upsampler up = {
        .kernels = &r->kernels,
        .photo = job->photo,
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
    struct job job = {r, photo, disparity};

    if (!r)
        return REFOCUS_ERR_ARGUMENT;
    r->prepared = r->blurred = false;
    memset(&r->made, 0, sizeof r->made);
    if (!rf_good_image(photo) || !rf_good_map(disparity))
        return REFOCUS_ERR_ARGUMENT;
    if (photo->width > r->max_width || photo->height > r->max_height)
        return REFOCUS_ERR_SIZE;
    r->photo[0].width = photo->width;
    r->photo[0].height = photo->height;
    r->photo[0].highlights_blend = RF_NO_BLEND;
    rf_use(r, 0, rf_whole(r, 0));
    r->blend = REFOCUS_BLEND_LINEAR; /* that rims are found in, whatever came before */
    memset(r->photo[0].band_blend, REFOCUS_BLEND_LINEAR, (size_t)rf_bands(r));
    rf_run_begin(r);
    rf_pool_run(&r->pool, convert_band, &job, rf_bands(r));
    if (disparity->width == r->width && disparity->height == r->height)
        rf_pool_run(&r->pool, disparity_band, &job, rf_bands(r));
    else
        upsample(r, &job);
    r->photo[0].rims = 0;
    if (!rf_cancelled(r))
        rf_find_rims(r, rf_whole(r, 0));
    if (r->previews && !rf_cancelled(r))
        rf_reduce_all(r);
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->prepared = true;
    return REFOCUS_OK;
}
