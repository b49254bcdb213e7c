#include <refocus/render.h>

#include <limits.h>
#include <math.h>
#include <string.h>

#include "background/background.h"
#include "methods/frame.h"
#include "planes/format.h"
#include "planes/planes.h"
#include "renderer/bands.h"
#include "renderer/params.h"
#include "renderer/rays.h"
#include "tiles/ranges.h"

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

static void blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_signed_blur_rows(f->r, f->focus, rf_band_start(band), rf_band_end(f->r, band));
    if (methods[f->params->method].frame && f->params->max_blur_radius > 0)
        return; /* the rest is what tiles are planned by */
    rf_cell_rows(f->r, band);
    rf_bin_tiles(f->r, f->scale, band);
}

static void dilate_item(void *context, int upwards, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_background_dilate(f->r, upwards);
}

static void smooth_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = f->r;
    const int i = f->prefilter_step;
    /* from the photo to r->smooth, and from there by way of the background's planes, which
     * are not in use yet */
    uint16_t *const *in = i == 0 ? r->front.light : i == 1 ? r->smooth : r->behind.light;
    uint16_t *const *out = i == 1 ? r->behind.light : r->smooth;

    if (i == 0)
        rf_range_rows(r, rf_scratch(r, worker), band);
    rf_prefilter_rows(r, out, in, f->prefilter_above, i, band);
}

/* All three steps or the first alone, so that the result is in r->smooth. */
static void prefilter(struct rf_frame *f)
{
    const int largest = f->focus.radius;
    const int steps = largest > f->prefilter_above[1] ? RF_PREFILTER_STEPS : 1;

    for (f->prefilter_step = 0; f->prefilter_step < steps; f->prefilter_step++)
        rf_pool_run(&f->r->pool, smooth_band, f, rf_bands(f->r));
}

static void mark_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    rf_background_mark_rows(f->r, rf_scratch(f->r, worker), rf_band_start(band),
                            rf_band_end(f->r, band));
}

static void weigh_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_weigh_rows(f->r, band);
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

static void find_lamps(void *context, int part, int worker)
{
    const struct rf_frame *f = context;

    rf_find_highlights(f->r, part, rf_scratch(f->r, worker));
}

static void prefilter_with_highlights(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;
    const float gain = f->params->highlight_gain;
    const int rays = f->params->rays == REFOCUS_RAYS_FULL ? INT_MAX : f->params->rays;

    if (gain > 1 && !r->highlights_found) {
        rf_pool_run(&r->pool, find_lamps, f, rf_lamp_parts(r->height));
        r->highlights_found = !rf_cancelled(r);
    }
    f->bright = gain > 1 && r->highlights_found &&
                rf_mark_highlights(r, f->scale, sqrt(3.14159265358979 / rays));
    if (f->bright)
        rf_add_highlights(r, gain, 1);
    prefilter(f);
    if (f->bright)
        rf_add_highlights(r, gain, -1);
}

/* From which blur on the rays of the preset lie 1.5, 3 and 6 pixels apart. */
static void set_prefilter(struct rf_frame *f)
{
    const struct refocus_render_params *p = f->params;

    for (int i = 0; i < RF_PREFILTER_STEPS; i++) {
        const double gap = 1.5 * (1 << i);
        const double above = 256 * gap * sqrt(p->rays / 3.14159265358979);

        f->prefilter_above[i] = INT16_MAX;
        if (p->prefilter && p->rays != REFOCUS_RAYS_FULL && above < INT16_MAX)
            f->prefilter_above[i] = (int)above;
    }
}

static void run_passes(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;
    const struct method *method = &methods[f->params->method];
    const bool layers = method->layers || f->params->background;
    struct rf_exact exact;

    if (r->blend != f->params->blend) { /* whole or not at all: not to be cancelled */
        for (int band = 0; band < rf_bands(r); band++)
            rf_reblend_rows(r, f->params->blend, rf_band_start(band), rf_band_end(r, band));
        r->blend = f->params->blend;
        r->highlights_found = false;
    }
    set_weights(f);
    if (method->exact) {
        rf_exact_init(&exact, r->blend, f->params->sigma);
        f->exact = &exact;
    }
    rf_pool_run(&r->pool, blur_band, f, rf_bands(r));
    if (f->params->max_blur_radius > 0)
        rf_make_rays(r, f->aperture, f->params->rays,
                     f->params->highlight_gain > 1, f->params->max_blur_radius);
    if (layers) {
        rf_patch_rims(r, f->focus, f->scale);
        prefilter_with_highlights(f);
        rf_pool_run(&r->pool, dilate_item, f, 2);
        rf_pool_run(&r->pool, mark_band, f, rf_bands(r));
        rf_background_fill(r);
        if (f->weighted && method->layers)
            rf_pool_run(&r->pool, weigh_band, f, rf_bands(r));
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
    rf_reach_init(&f.reach, f.scale, r->pad, f.aperture->shape == RF_SHAPE_MASK);
    f.first_tx = f.region.x0 / RF_TILE;
    f.first_ty = f.region.y0 / RF_TILE;
    f.count_tx = (f.region.x1 - 1) / RF_TILE - f.first_tx + 1;
    f.count_ty = (f.region.y1 - 1) / RF_TILE - f.first_ty + 1;
    set_prefilter(&f);
    rf_run_begin(r);
    r->blurred = false;
    run_passes(&f);
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->blurred = true;
    return REFOCUS_OK;
}
