#include "renderer/load.h"

#include "depth/dequantise.h"
#include "passes/planes.h"
#include "passes/yuv.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/compare.h"

struct job {
    struct refocus_renderer *r;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    uint16_t *disparity; /* the plane, where the map's first pixel goes */
    const struct refocus_image *guide;
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;

    if (job->r->yuv.on)
        rf_yuv_convert_rows(job->r, job->photo, job->guide,
                            (uint8_t *)rf_scratch(&job->r->exec, worker), rf_band_start(band),
                            rf_band_end(&job->r->view, band));
    else
        rf_convert_rows(job->r, job->photo, rf_band_start(band), rf_band_end(&job->r->view, band));
}

static void disparity_band(void *context, int band, int worker)
{
    const struct job *job = context;
    const int end = rf_smaller((band + 1) * RF_TILE, job->map->height);

    (void)worker;
    rf_disparity_rows(job->disparity, job->r->view.stride, job->map, band * RF_TILE, end);
}

void rf_load_light(struct refocus_renderer *r, const struct refocus_image *photo,
                   const struct refocus_image *guide)
{
    struct job job = {.r = r, .photo = photo, .guide = guide};

    rf_pool_run(&r->pool, convert_band, &job, rf_bands(&r->view));
}

/* The planes of pre-filtered light are free until something is rendered. */
static void dequantise(struct refocus_renderer *r, const struct job *job, int step, ptrdiff_t first)
{
    const struct rf_dequantiser d = {
        .kernels = r->exec.kernels,
        .code = job->disparity,
        .stride = r->view.stride,
        .spare = {r->smooth.channel[1] + first, r->smooth.channel[2] + first},
        .spare_stride = {r->view.stride, r->view.stride},
        .width = job->map->width,
        .height = job->map->height,
        .step = step,
    };

    rf_dequantise(&d, &r->pool);
}

void rf_load_disparity(struct refocus_renderer *r, const struct refocus_disparity *map, int step,
                       int left, int above)
{
    const ptrdiff_t first = -above * r->view.stride - left;
    struct job job = {.r = r, .map = map, .disparity = r->disparity.at + first};

    rf_pool_run(&r->pool, disparity_band, &job, (map->height + RF_TILE - 1) / RF_TILE);
    if (step)
        dequantise(r, &job, step, first);
}
