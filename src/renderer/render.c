#include <refocus/render.h>

#include <math.h>
#include <string.h>

#include "background/background.h"
#include "methods/frame.h"
#include "planes/format.h"
#include "planes/planes.h"
#include "renderer/bands.h"
#include "renderer/params.h"
#include "renderer/rays.h"

struct method {
    const char *name, *summary;
    rf_tile_fn *tile;   /* called for each tile, or */
    rf_frame_fn *frame; /* once for the whole frame */
    bool layers; /* it needs the pre-filter, the bins of tiles and the background */
    bool exact;  /* it works in double precision */
};

static const struct method methods[REFOCUS_METHOD_COUNT] = {
    [REFOCUS_METHOD_SWEEP] = {"sweep", "two layers, front-most hit, swept over disparities",
                              .tile = rf_sweep_tile, .layers = true},
    [REFOCUS_METHOD_SEARCH] = {"search", "randomized intersection search, Yang et al. 2016",
                               .tile = rf_search_tile},
    [REFOCUS_METHOD_RAYTRACE] = {"raytrace",
                                 "full image-space ray tracing, Yang et al. 2016; slow",
                                 .tile = rf_raytrace_tile, .exact = true},
    [REFOCUS_METHOD_JITTERED] = {"jittered",
                                 "the same for a ray of each cell of the mask; slow, grainy",
                                 .tile = rf_jittered_tile, .exact = true},
    [REFOCUS_METHOD_LIGHTFIELD] = {"lightfield",
                                   "views from all over the aperture, warped and added up",
                                   .frame = rf_lightfield_frame},
    [REFOCUS_METHOD_BLUR] = {"blur", "each pixel blurred by its own circle of confusion",
                             .tile = rf_gather_tile},
    [REFOCUS_METHOD_SCATTER] = {"scatter",
                                "each pixel spread over its circle, Potmesil 1981",
                                .frame = rf_scatter_frame},
    [REFOCUS_METHOD_FOVEATED] = {"foveated",
                                 "exact at the centre of attention, Mulder 2000",
                                 .frame = rf_foveated_frame},
    [REFOCUS_METHOD_INTERPOLATED] = {"interpolated",
                                     "between three pictures, NVIDIA 2004; quick",
                                     .frame = rf_interpolated_frame},
    [REFOCUS_METHOD_DIFFUSION] = {"diffusion",
                                  "heat through a field of blur, Kosloff 2007",
                                  .frame = rf_diffusion_frame},
};

const char *refocus_method_name(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? methods[method].name : NULL;
}

const char *refocus_method_summary(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? methods[method].summary : NULL;
}

int refocus_format_bytes(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
    case REFOCUS_FORMAT_BGR8:
        return 3;
    case REFOCUS_FORMAT_RGBA8:
    case REFOCUS_FORMAT_BGRA8:
        return 4;
    }
    return 0;
}

/* The part of the picture to render; false if it is not inside. */
static bool region_of(const struct refocus_renderer *r,
                      const struct refocus_render_params *p, struct rf_rect *region)
{
    const bool whole = !p->region_x && !p->region_y && !p->region_width && !p->region_height;
    const int w = whole ? r->width : p->region_width;
    const int h = whole ? r->height : p->region_height;

    *region = (struct rf_rect){p->region_x, p->region_y, 0, 0};
    if (p->region_x < 0 || p->region_y < 0 || w < 1 || h < 1 ||
        w > r->width - p->region_x || h > r->height - p->region_y)
        return false;
    region->x1 = region->x0 + w;
    region->y1 = region->y0 + h;
    return true;
}

static void reblend_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_reblend_rows(f->r, f->params->blend, rf_band_start(band), rf_band_end(f->r, band));
}

static void blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_signed_blur_rows(f->r, f->focus, rf_band_start(band), rf_band_end(f->r, band));
}

static void smooth_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_prefilter_rows(f->r, f->prefilter_above, rf_band_start(band),
                      rf_band_end(f->r, band));
    rf_bin_tiles(f->r, f->scale, band);
}

static void extend_behind_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    const int y0 = rf_band_start(band), y1 = rf_band_end(f->r, band);

    (void)worker;
    for (int c = 0; c < 3; c++)
        rf_extend_rows(f->r, f->r->behind.light[c], y0, y1);
    rf_extend_rows(f->r, f->r->behind.blur, y0, y1);
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static void tile_item(void *context, int item, int worker)
{
    const struct rf_frame *f = context;
    const int tx = f->first_tx + item % f->count_tx, ty = f->first_ty + item / f->count_tx;
    const struct rf_rect rect = {
        larger(tx * RF_TILE, f->region.x0),
        larger(ty * RF_TILE, f->region.y0),
        smaller((tx + 1) * RF_TILE, f->region.x1),
        smaller((ty + 1) * RF_TILE, f->region.y1),
    };

    if (f->params->max_blur_radius > 0)
        methods[f->params->method].tile(f, tx, ty, rect, worker);
    else
        rf_copy_tile(f, rect); /* a pinhole */
}

/* Eq. 5 over the Q12 values of the blend in use. */
static void set_weights(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;
    uint16_t weight[256];
    const float sigma = f->params->sigma;

    f->weighted = sigma < 1e6f; /* beyond it all weights round to 1 */
    if (!f->weighted || (r->weight_sigma == sigma && r->weight_blend == r->blend))
        return;
    rf_highlight_weights(weight, sigma);
    for (int light = 0; light <= RF_LIGHT_MAX; light++)
        r->light_weight[light] = weight[r->transfer[r->blend].to_code[4 * light]];
    r->weight_sigma = sigma;
    r->weight_blend = r->blend;
}

static void run_passes(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;
    const struct method *method = &methods[f->params->method];
    const bool layers = method->layers || f->params->background;
    struct rf_exact exact;

    if (r->blend != f->params->blend) {
        rf_pool_run(&r->pool, reblend_band, f, rf_bands(r));
        if (rf_cancelled(r)) {
            r->prepared = false; /* planes are in two blends now */
            return;
        }
        r->blend = f->params->blend;
    }
    set_weights(f);
    if (method->exact) {
        rf_exact_init(&exact, r->blend, f->params->sigma);
        f->exact = &exact;
    }
    rf_pool_run(&r->pool, blur_band, f, rf_bands(r));
    if (f->params->max_blur_radius > 0)
        rf_make_rays(r, f->aperture, f->params->rays, f->params->max_blur_radius);
    if (layers)
        rf_pool_run(&r->pool, smooth_band, f, rf_bands(r));
    if (layers && !rf_cancelled(r)) {
        rf_background(r);
        rf_pool_run(&r->pool, extend_behind_band, f, rf_bands(r));
    }
    if (method->frame && f->params->max_blur_radius > 0) {
        if (!rf_cancelled(r))
            method->frame(f);
        return;
    }
    rf_pool_run(&r->pool, tile_item, f, f->count_tx * f->count_ty);
}

int refocus_render(struct refocus_renderer *r, const struct refocus_render_params *params,
                   const struct refocus_image *out)
{
    struct rf_frame f = {.r = r, .params = params, .out = out};

    if (!r)
        return REFOCUS_ERR_ARGUMENT;
    if (!r->prepared)
        return REFOCUS_ERR_STATE;
    if (!rf_good_params(r, params) || !region_of(r, params, &f.region) ||
        !rf_good_image(out) || out->width != f.region.x1 - f.region.x0 || out->height != f.region.y1 - f.region.y0)
        return REFOCUS_ERR_ARGUMENT;
    f.aperture = params->aperture ? params->aperture : &rf_disc;
    f.focus = rf_focus_of(params->focus_disparity, params->max_blur_radius);
    f.scale = rf_bin_scale_of(params->max_blur_radius);
    f.first_tx = f.region.x0 / RF_TILE;
    f.first_ty = f.region.y0 / RF_TILE;
    f.count_tx = (f.region.x1 - 1) / RF_TILE - f.first_tx + 1;
    f.count_ty = (f.region.y1 - 1) / RF_TILE - f.first_ty + 1;
    f.prefilter_above = INT16_MAX;
    if (params->prefilter && params->rays != REFOCUS_RAYS_FULL)
        /* rays of a set of N are s sqrt(pi / N) apart: from 1.5 pixels on */
        f.prefilter_above = (int)floor(256 * 1.5 * sqrt(params->rays / 3.14159265358979));
    rf_run_begin(r);
    r->blurred = false;
    run_passes(&f);
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->blurred = true;
    return REFOCUS_OK;
}
