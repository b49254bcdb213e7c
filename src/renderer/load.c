#include "renderer/load.h"

#include "planes/planes.h"
#include "planes/yuv.h"
#include "renderer/bands.h"

struct job {
    struct refocus_renderer *r;
    const struct refocus_image *photo;
    const struct refocus_disparity *map;
    const struct refocus_image *guide;
};

static void convert_band(void *context, int band, int worker)
{
    const struct job *job = context;

    if (job->r->yuv.on)
        rf_yuv_convert_rows(job->r, job->photo, job->guide,
                            (uint8_t *)rf_scratch(job->r, worker), rf_band_start(band),
                            rf_band_end(job->r, band));
    else
        rf_convert_rows(job->r, job->photo, rf_band_start(band), rf_band_end(job->r, band));
}

static void disparity_band(void *context, int band, int worker)
{
    const struct job *job = context;

    (void)worker;
    rf_disparity_rows(job->r, job->map, rf_band_start(band), rf_band_end(job->r, band));
}

void rf_load_light(struct refocus_renderer *r, const struct refocus_image *photo,
                   const struct refocus_image *guide)
{
    struct job job = {r, photo, NULL, guide};

    rf_pool_run(&r->pool, convert_band, &job, rf_bands(r));
}

void rf_load_disparity(struct refocus_renderer *r, const struct refocus_disparity *map)
{
    struct job job = {r, NULL, map, NULL};

    rf_pool_run(&r->pool, disparity_band, &job, rf_bands(r));
}
