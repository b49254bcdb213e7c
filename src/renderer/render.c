/* render.c: renders one frame: checks it, runs its passes and then its tiles. */
#include <refocus/render.h>

#include <math.h>
#include <string.h>

#include "highlights/highlights.h"
#include "highlights/known.h"
#include "gather/tile_rows.h"
#include "image/read.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "renderer/methods.h"
#include "renderer/params.h"
#include "renderer/passes.h"
#include "renderer/settings.h"
#include "support/compare.h"
#include "thin/thin.h"

/* The part of a photo to render. */
static int read_region(const struct rf_log *log, const struct refocus_renderer *r,
                       const struct rf_settings *p, struct rf_rect *region)
{
    const int width = r->photo.width, height = r->photo.height;
    const bool whole = !p->region_x && !p->region_y && !p->region_width && !p->region_height;
    const int w = whole ? width : p->region_width;
    const int h = whole ? height : p->region_height;

    *region = (struct rf_rect){p->region_x, p->region_y, 0, 0};
    if (p->region_x < 0 || p->region_y < 0 || w < 1 || h < 1 || w > width - p->region_x ||
        h > height - p->region_y)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "region is %d x %d at (%d, %d), may be within %d x %d", w, h,
                         (int)p->region_x, (int)p->region_y, width, height);
    region->x1 = region->x0 + w;
    region->y1 = region->y0 + h;
    return REFOCUS_OK;
}

static void lay_look(const struct rf_frame *f, struct rf_rect rect)
{
    const struct rf_canvas canvas = {f->view, f->blur, f->out, f->region};

    rf_look_over(&f->look, &canvas, rect);
}

/* The part of tile (tx, ty) that is to be rendered. */
static struct rf_rect part_of_tile(const struct rf_frame *f, int tx, int ty)
{
    return (struct rf_rect){
        rf_larger(tx * RF_TILE, f->region.x0), rf_larger(ty * RF_TILE, f->region.y0),
        rf_smaller((tx + 1) * RF_TILE, f->region.x1), rf_smaller((ty + 1) * RF_TILE, f->region.y1)};
}

static void tile_item(void *context, int item, int worker)
{
    const struct rf_frame *f = context;
    const int tx = f->first_tx + item % f->count_tx, ty = f->first_ty + item / f->count_tx;
    const struct rf_rect rect = part_of_tile(f, tx, ty);

    if (f->params->max_blur_radius > 0 && rf_renderer_of(f)->yuv->on)
        f->method->yuv_tile(f, tx, ty, rect, worker);
    else if (f->params->max_blur_radius > 0)
        f->method->tile(f, tx, ty, rect, worker);
    else if (rf_renderer_of(f)->yuv->on)
        rf_copy_yuv_tile(f, rect);
    else
        rf_copy_tile(f, rect); /* a pinhole */
    if (!rf_cancelled(&rf_renderer_of(f)->exec))
        lay_look(f, rect);
}

static void block_item(void *context, int item, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_join_blocks(f->view, f->bins, rf_renderer_of(f)->blocks, item);
}

static void look_item(void *context, int item, int worker)
{
    const struct rf_frame *f = context;
    const int tx = f->first_tx + item % f->count_tx, ty = f->first_ty + item / f->count_tx;

    (void)worker;
    lay_look(f, part_of_tile(f, tx, ty));
}

/* Sets up the thin structures of a photo, where the renderer has memory for them. */
static void set_up_thin(struct rf_frame *f)
{
    const struct rf_settings *p = f->params;

    rf_thin_set_up(
        &f->thin,
        &(struct rf_thin_settings){
            .on = rf_renderer_of(f)->has_thin && p->method == REFOCUS_METHOD_SWEEP &&
                  p->max_blur_radius > 0,
            .finds = p->thin,
            .splats = p->cat_eye <= 0 && p->fringe == 0 && !f->fine && !rf_renderer_of(f)->yuv->on,
            .rays = p->rays,
            .set = &rf_renderer_of(f)->ray_sets.set[rf_renderer_of(f)->ray_sets.preset],
        });
}

/* Sets the rectangle of tiles that tile_item() goes through. */
static void set_tiles(struct rf_frame *f)
{
    f->first_tx = f->region.x0 / RF_TILE;
    f->first_ty = f->region.y0 / RF_TILE;
    f->count_tx = (f->region.x1 - 1) / RF_TILE - f->first_tx + 1;
    f->count_ty = (f->region.y1 - 1) / RF_TILE - f->first_ty + 1;
}

/* Begins the look, once, when the photo's light is in the blend in use and its highlights are
 * found. */
static void begin_look(struct rf_frame *f)
{
    if (f->look_ready)
        return;
    f->look.photo = rf_photo_source(rf_renderer_of(f));
    rf_look_begin(&f->look);
    f->look_ready = true;
}

static void run_tiles(struct rf_frame *f)
{
    rf_set_gather_planes(f);
    set_tiles(f);
    begin_look(f);
    if (f->focus.unit) {
        f->reach.blocks = rf_renderer_of(f)->blocks;
        rf_pool_run(&rf_renderer_of(f)->pool, block_item, f, rf_block_rows(f->view));
    }
    rf_pool_run(&rf_renderer_of(f)->pool, tile_item, f, f->count_tx * f->count_ty);
}

/* Where rays gather highlights, long steps would spread one of a pixel so thin that Q12 rounds
 * it away. */
static int prefilter_steps(const struct rf_frame *f)
{
    const bool gathers = f->params->highlight_gain > 1 && !f->splats;

    return gathers && !f->focus.unit ? 3 : rf_prefilter_most_steps(f->params->max_blur_radius);
}

static void run(struct rf_frame *f, struct rf_rect region)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_method *method = f->method;
    const bool pinhole = f->params->max_blur_radius <= 0;
    const bool layers = method->layers || f->params->background || rf_searches_subtracted(f);
    const enum rf_need need = pinhole ? RF_NEED_LIGHT : layers ? RF_NEED_LAYERS : RF_NEED_BLUR;

    f->textured = layers && !pinhole && r->texture && !r->yuv->on &&
                  f->params->inpaint == REFOCUS_INPAINT_TEXTURED;
    rf_set_planes(f);
    r->last_silhouettes = layers;
    if (!pinhole)
        rf_ray_sets_make(&r->ray_sets,
                         &(struct rf_ray_request){
                             .aperture = f->aperture,
                             .rays = f->params->rays,
                             .denser = f->params->highlight_gain > 1 && !f->splats,
                             .chroma = r->yuv->on,
                             .max_blur_radius = fminf(f->params->max_blur_radius, RF_PLAIN_RADIUS),
                         },
                         &r->run);
    if (f->params->cat_eye > 0) {
        rf_cat_eye_make(r->cat_eye);
        rf_cat_shape_make(r->cat_shape, f->aperture);
    }
    if (rf_cancelled(&r->exec))
        return;
    set_up_thin(f);
    f->row_gap = pinhole ? 0 : rf_row_gap(f);
    if (r->in_place.on) {
        rf_run_strips(f, region, need, run_tiles);
        return;
    }
    rf_run_passes(f, region, need,
                  method->frame != NULL || r->yuv->on || f->textured || (layers && !f->plan.plain));
    if (rf_cancelled(&r->exec))
        return;
    if (!method->frame || pinhole) {
        run_tiles(f);
        return;
    }
    rf_set_gather_planes(f);
    method->frame(f);
    if (rf_cancelled(&r->exec) || !f->look.has_grain)
        return;
    set_tiles(f);
    begin_look(f);
    rf_pool_run(&r->pool, look_item, f, f->count_tx * f->count_ty);
}

/* Read and check what refocus_render() is given; the settings stay with the renderer. */
static int read_arguments(struct rf_frame *f, const struct rf_log *log,
                          const struct refocus_render_params *params, struct refocus_image *own_out,
                          const struct refocus_image *out)
{
    struct refocus_renderer *const r = rf_renderer_of(f);
    struct rf_settings settings;
    int status;

    if (!r->prepared)
        return rf_refuse(log, REFOCUS_ERR_STATE, "nothing is prepared yet");
    if ((status = rf_read_settings(log, &settings, params)) ||
        (status = rf_check_settings(log, r, &settings)) ||
        (status = read_region(log, r, &settings, &f->region)) ||
        (status = rf_read_any_image(log, "out", own_out, out)))
        return status;
    if (r->deep.on && r->deep.exceeds) {
        settings.highlight_estimate = 0;
        settings.highlight_gain = RF_KNOWN_GAIN;
    }
    if (!r->highlights_memory) {
        settings.highlight_gain = 1;
        settings.star_strength = 0;
    }
    if (own_out->width != f->region.x1 - f->region.x0 ||
        own_out->height != f->region.y1 - f->region.y0)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "out is %d x %d, may be %d x %d, as the region",
                         (int)own_out->width, (int)own_out->height, f->region.x1 - f->region.x0,
                         f->region.y1 - f->region.y0);
    f->out = own_out;
    f->params = &settings;
    if ((status = rf_check_yuv(log, f, f->region)) || (status = rf_check_deep(log, f, f->region)))
        return status;
    rf_deep_begin(&r->deep_out, own_out, false);
    f->dither = r->deep.on && !r->deep_out.on && settings.dither == REFOCUS_DITHER_ORDERED;
    if (f->dither)
        rf_deep_begin_codes(&r->deep_out);
    rf_keep_settings(&r->settings, &settings);
    f->params = &r->settings;
    return REFOCUS_OK;
}

static int render(struct refocus_renderer *r, const struct rf_log *log,
                  const struct refocus_render_params *given, const struct refocus_image *out)
{
    struct rf_frame *const f = r->frame;
    const struct rf_settings *params;
    struct refocus_image own_out;
    struct rf_rect region;
    float largest;
    int status;

    memset(f, 0, sizeof *f);
    f->owner = r;
    if ((status = read_arguments(f, log, given, &own_out, out)))
        return status;
    params = f->params;
    region = f->region;
    f->aperture = params->aperture ? params->aperture : &rf_disc;
    f->fine = rf_aperture_is_fine(f->aperture);
    f->splats = (rf_is_search(f) || (rf_is_sweep(f) && !rf_weighs(params))) &&
                rf_can_splat(params, f->aperture);
    f->focus = rf_focus_of(params->focus_disparity, params->max_blur_radius);
    rf_focus_plan_make(&f->plan, params, f->focus, r->photo.width, r->photo.height);
    if (f->plan.surface || f->plan.sharp || f->plan.picture)
        f->plan.number = ++r->renders;
    largest = rf_focus_largest(&f->plan, params->max_blur_radius);
    f->scale = rf_bin_scale_of(largest, f->focus.unit);
    r->unit = f->focus.unit;
    f->look = (struct rf_look){
        .has_stars = params->star_spikes > 0 && params->star_strength > 0 &&
                     params->star_length > 0 && params->method == REFOCUS_METHOD_SWEEP &&
                     params->max_blur_radius > 0,
        .has_grain = params->grain > 0 && params->max_blur_radius > 0,
        .exec = &r->exec,
        .params = params,
        .plan = &f->plan,
        .highlights = &r->photo.highlights,
        .stars = &r->stars,
        .grain = r->grain,
    };
    f->method = rf_method_of(r->papers, params->method);
    if (f->method->exact) {
        f->method->exact(r->exact, params->blend, params->sigma);
        f->exact = r->exact;
    }
    rf_reach_init(&f->reach, f->scale, largest, r->photo.pad,
                  rf_aperture_fills_square(f->aperture));
    /* The steps of live frames set in gradually; those of stills, which do not move, at once, as
     * highlights keep more of their light then. */
    f->prefilter_fades = params->rays <= RF_LIVE_RAYS;
    rf_prefilter_bounds(f->prefilter_above, prefilter_steps(f), params->rays,
                        params->prefilter && !rf_searches_subtracted(f) ? f->focus.radius : 0,
                        f->focus.unit);
    r->blurred = false;
    r->last_plan = f->plan;
    rf_run_begin(r);
    run(f, region);
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->blurred = true;
    return REFOCUS_OK;
}

int refocus_render(struct refocus_renderer *r, const struct refocus_render_params *params,
                   const struct refocus_image *out)
{
    struct rf_log log = {.function = "refocus_render"};
    const int status = rf_enter(r, &log);

    return status ? status : rf_leave(r, render(r, &log, params, out));
}
