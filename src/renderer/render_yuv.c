#include "renderer/render_yuv.h"

#include <limits.h>
#include <math.h>

#include "background/background.h"
#include "planes/format.h"
#include "planes/yuv.h"
#include "renderer/bands.h"
#include "renderer/rays.h"
#include "tiles/ranges.h"

int rf_check_yuv(const struct rf_frame *f)
{
    const struct refocus_renderer *r = f->r;
    const struct rf_rect region = f->region;
    const int odd_rows = r->yuv.down ? 1 : 0;

    if (refocus_format_is_yuv(f->out->format) != r->yuv.on)
        return REFOCUS_ERR_UNSUPPORTED;
    if (!r->yuv.on)
        return REFOCUS_OK;
    if (rf_chroma_down(f->out->format) != r->yuv.down ||
        f->params->method != REFOCUS_METHOD_SWEEP)
        return REFOCUS_ERR_UNSUPPORTED;
    if (region.x0 % 2 || (region.x1 % 2 && region.x1 < r->width) ||
        ((region.y0 & odd_rows) || ((region.y1 & odd_rows) && region.y1 < r->height)))
        return REFOCUS_ERR_ARGUMENT;
    return REFOCUS_OK;
}

static void blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_signed_blur_rows(f->r, f->focus, rf_band_start(band), rf_band_end(f->r, band));
    rf_cell_rows(f->r, band);
    rf_bin_tiles(f->r, f->scale, band);
}

static void chroma_blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_yuv_blur_rows(f->r, rf_band_start(band), rf_band_end(f->r, band));
}

/* From the photo to r->smooth, and from there by way of the background's planes. */
static void smooth_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = f->r;
    const struct rf_yuv *yuv = &r->yuv;
    const int i = f->prefilter_step, step = 1 << i;
    uint16_t *const luma[] = {r->front.light[0], r->smooth[0], r->behind.light[0]};
    uint16_t *const chroma[] = {yuv->light, yuv->smooth, yuv->behind};
    const int to = i == 1 ? 2 : 1;
    /* half the rays, twice the pixels: sqrt 2 of the blur for the same gap among samples */
    const int above = f->prefilter_above[i] < INT16_MAX ? f->prefilter_above[i] * 181 / 128
                                                        : INT16_MAX;

    if (i == 0)
        rf_range_rows(r, rf_scratch(r, worker), band);
    rf_yuv_prefilter_luma(r, luma[to], luma[i], step, f->prefilter_above[i],
                          rf_scratch(r, worker), band);
    rf_yuv_prefilter_chroma(r, chroma[to], chroma[i], step,
                            above < INT16_MAX ? above : INT16_MAX, rf_scratch(r, worker),
                            band);
}

static void prefilter(struct rf_frame *f)
{
    const int steps = f->focus.radius > f->prefilter_above[1] ? RF_PREFILTER_STEPS : 1;

    for (f->prefilter_step = 0; f->prefilter_step < steps; f->prefilter_step++)
        rf_pool_run(&f->r->pool, smooth_band, f, rf_bands(f->r));
}

static void find_lamps(void *context, int part, int worker)
{
    const struct rf_frame *f = context;

    rf_find_highlights(f->r, part, rf_scratch(f->r, worker));
}

/* Lamps are told, and given back light, by luminance alone. */
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

static void dilate_item(void *context, int upwards, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_background_dilate(f->r, upwards);
}

static void mark_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    rf_background_yuv_mark_rows(f->r, rf_scratch(f->r, worker), rf_band_start(band),
                                rf_band_end(f->r, band));
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
        rf_sweep_yuv_tile(f, tx, ty, rect, worker);
    else
        rf_copy_yuv_tile(f, rect); /* a pinhole */
}

/* Eq. 5 over Q12 luminance in place of max(R, G, B). */
static void set_weights(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;
    const float sigma = f->params->sigma;
    uint16_t weight[256];

    f->weighted = sigma < 1e6f;
    if (!f->weighted || (r->weight_sigma == sigma && r->weight_blend == r->blend))
        return;
    rf_highlight_weights(weight, sigma);
    for (int light = 0; light <= RF_LIGHT_MAX; light++)
        r->light_weight[light] = weight[r->transfer[r->blend].to_code[4 * light]];
    r->weight_sigma = sigma;
    r->weight_blend = r->blend;
}

void rf_run_yuv(struct rf_frame *f)
{
    struct refocus_renderer *r = f->r;

    if (r->blend != f->params->blend) { /* whole or not at all: not to be cancelled */
        rf_yuv_reblend(r, f->params->blend);
        r->blend = f->params->blend;
        r->highlights_found = false;
    }
    set_weights(f);
    rf_pool_run(&r->pool, blur_band, f, rf_bands(r));
    if (f->params->max_blur_radius > 0)
        rf_make_rays(r, f->aperture, f->params->rays, f->params->highlight_gain > 1,
                     f->params->max_blur_radius);
    rf_patch_rims(r, f->focus, f->scale);
    rf_pool_run(&r->pool, chroma_blur_band, f, rf_bands(r));
    prefilter_with_highlights(f);
    rf_pool_run(&r->pool, dilate_item, f, 2);
    rf_pool_run(&r->pool, mark_band, f, rf_bands(r));
    rf_background_yuv_fill(r);
    rf_pool_run(&r->pool, tile_item, f, f->count_tx * f->count_ty);
}
