/* passes.c: runs each pass over the window, on the planes that it reads and writes. */
#include "renderer/passes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "highlights/estimate.h"
#include "highlights/highlights.h"
#include "highlights/known.h"
#include "passes/coc.h"
#include "passes/expand_chroma.h"
#include "passes/prefilter.h"
#include "passes/weights.h"
#include "image/border.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/compare.h"
#include "thin/thin.h"
#include "tiles/ranges.h"

/* Computes eq. 5 over the Q12 values of the blend in use. */
void rf_set_weights(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const float sigma = f->params->sigma;

    f->weighted = rf_weighs(f->params);
    if (!f->weighted || (r->weight_sigma == sigma && r->weight_blend == r->blend))
        return;
    rf_weights_of_light(r->light_weight, &r->transfer[r->blend], sigma);
    r->weight_sigma = sigma;
    r->weight_blend = r->blend;
}

/* Works in the planes of a lens setting, whose contents end. */
static void find_highlights(struct refocus_renderer *r, const struct rf_settings *params)
{
    const struct rf_frame_of_light frame = {r->photo.width, r->photo.height, (int32_t)r->blend,
                                            params->highlight_estimate};
    const struct rf_photo_source source = rf_photo_source(r);
    struct rf_arena arena = {r->highlights_memory, 0};
    struct rf_light_grid grid = {.exec = &r->exec, .photo = &source};

    rf_planes_end(&r->lifetimes);
    r->cache = (struct rf_pass_cache){0};
    rf_estimate_highlights(&grid, &arena, &r->transfer[REFOCUS_BLEND_LINEAR],
                           params->highlight_estimate, &r->photo.highlights);
    if (params->highlight_steady > 0 && !rf_cancelled(&r->exec))
        rf_steady_highlights(&r->photo.highlights, &r->last_light, &frame, params->highlight_steady,
                             r->highlights_memory);
    else
        r->last_light.of.width = 0;
}

void rf_pass_highlights(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_photo *photo = &r->photo;
    const float estimate = f->params->highlight_estimate;
    const float steady = f->params->highlight_steady;

    if (!r->highlights_memory || (f->params->highlight_gain <= 1 && !f->look.has_stars) ||
        (photo->highlights_blend == r->blend && photo->highlights_estimate == estimate &&
         photo->highlights_steady == steady))
        return;
    photo->highlights_blend = RF_NO_BLEND;
    photo->highlights_estimate = estimate;
    photo->highlights_steady = steady;
    if (f->splat.window.known)
        rf_list_known(&r->exec, &r->deep, &photo->highlights);
    else
        find_highlights(r, f->params);
    photo->highlights_blend = rf_cancelled(&r->exec) ? RF_NO_BLEND : r->blend;
}

void rf_pass_silhouettes(struct rf_frame *f)
{
    const struct rf_blur_patch patch = {f->view, f->blur, rf_renderer_of(f)->bins, f->scale,
                                        &rf_renderer_of(f)->cells};

    rf_patch_silhouettes(f->exec, &rf_renderer_of(f)->photo.silhouettes, &f->plan, &patch);
}

static void blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = rf_renderer_of(f);

    (void)worker;
    rf_coc_rows(&r->exec, &r->view, &f->plan, r->disparity, r->blur, rf_band_start(band),
                rf_band_end(&r->view, band));
    rf_cell_rows(&r->exec, &r->view, r->blur, &r->cells, band);
    rf_bin_tiles(&r->view, f->scale, r->blur, &r->cells, r->bins, band);
}

static void chroma_blur_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    const struct refocus_renderer *r = rf_renderer_of(f);

    (void)worker;
    rf_coc_chroma_rows(&r->exec, &r->view, &r->chroma.size, r->blur, r->chroma.blur,
                       rf_band_start(band), rf_band_end(&r->view, band));
}

static struct rf_range_pass range_pass(const struct refocus_renderer *r)
{
    return (struct rf_range_pass){r->cells, r->foreground, r->yuv->on, r->range};
}

static void range_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    const struct rf_range_pass pass = range_pass(rf_renderer_of(f));

    rf_range_rows(&rf_renderer_of(f)->exec, &rf_renderer_of(f)->view, &pass, band, worker);
}

static struct rf_prefilter_chroma prefilter_chroma(const struct rf_frame *f)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_prefilter_chroma pass = {
        .size = r->chroma.size,
        .blur = r->chroma.blur,
        .light = r->chroma.light,
        .spare = r->chroma.background,
        .smooth = r->chroma.smooth,
    };
    const float largest =
        256 * rf_focus_largest(&f->plan, f->params->max_blur_radius) / (float)(1 << f->focus.unit);

    rf_prefilter_chroma_bounds(pass.above, f->prefilter_above,
                               &r->ray_sets.set[r->ray_sets.preset]);
    pass.steps = rf_prefilter_steps(pass.above, largest);
    return pass;
}

/* Pre-filters the light. The hidden background's planes serve as scratch: they are not in use yet.
 */
static void prefilter(struct rf_frame *f)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_prefilter_chroma chroma;
    struct rf_prefilter pass = {
        .fades = f->prefilter_fades,
        .steps = rf_prefilter_steps(f->prefilter_above, f->focus.radius),
        .bins = r->bins,
        .blur = r->blur,
        .light = r->light,
        .spare = r->background.light,
        .smooth = r->smooth,
    };

    memcpy(pass.above, f->prefilter_above, sizeof pass.above);
    if (r->yuv->on) {
        chroma = prefilter_chroma(f);
        pass.chroma = &chroma;
    }
    rf_prefilter(&r->exec, &r->view, &pass);
}

float rf_gathered_gain(const struct rf_frame *f)
{
    const float gain = f->splats ? 1 : f->params->highlight_gain;

    return rf_renderer_of(f)->yuv->on && f->weighted ? fminf(gain, RF_PLAIN_GAIN) : gain;
}

static void mark_highlights(struct rf_frame *f)
{
    const struct rf_highlight_window *window = &f->splat.window;

    f->bright = !rf_leaves_known(window) ? RF_WHITE : rf_is_search(f) ? RF_BRIGHTER : RF_BRIGHTEST;
    if (f->params->highlight_gain <= 1 || !rf_has_highlights(window->highlights, window->view))
        return;
    if (window->known) /* the hidden background is inpainted from it, too */
        f->bright = (enum rf_bright)rf_larger(f->bright, RF_BRIGHT);
    rf_mark_highlights(f->exec, window, f->splats);
    if (f->splats)
        return;
    rf_note_undersampled(f->exec, window, rf_ray_gap(f->params->rays));
    f->bright = (enum rf_bright)rf_larger(f->bright, rf_bright_of(rf_gathered_gain(f)));
}

bool rf_boosts(const struct rf_frame *f)
{
    return f->bright != RF_WHITE && (!f->splats || f->splat.window.known);
}

void rf_pass_boost(struct rf_frame *f)
{
    const double gap = rf_ray_gap(f->params->rays);
    const int most = rf_most_light(f->bright);

    if (f->bright != RF_WHITE && !f->splats)
        rf_boost_highlights(f->exec, &f->splat.window, f->smooth, rf_gathered_gain(f), gap, most);
    if (f->bright != RF_WHITE && f->splat.window.known)
        rf_boost_known(f->exec, &f->splat.window, f->smooth, f->background, gap, most);
}

/* Afterwards the light is the photo's again, whatever happens, as the next frame needs it too. */
void rf_pass_prefilter(struct rf_frame *f)
{
    const struct rf_photo_source source = rf_photo_source(rf_renderer_of(f));
    struct rf_lifetimes *lifetimes = &rf_renderer_of(f)->lifetimes;

    rf_plane_read(lifetimes, RF_PLANE_BLUR);
    rf_plane_begin(lifetimes, RF_PLANE_PREFILTER_SPARE);
    rf_plane_begin(lifetimes, RF_PLANE_SMOOTH);
    if (rf_thin_is_separated(&f->thin))
        rf_thin_swap_light(&f->thin);
    if (f->splats)
        rf_subtract_highlights(f->exec, &f->splat.window, &source, rf_ray_gap(f->params->rays),
                               f->background.light);
    prefilter(f);
    if (rf_thin_is_separated(&f->thin))
        rf_thin_swap_light_back(&f->thin);
}

void rf_pass_blur(struct rf_frame *f, bool layers)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    rf_plane_begin(&r->lifetimes, RF_PLANE_BLUR);
    rf_plane_begin(&r->lifetimes, RF_PLANE_CELLS);
    rf_pool_run(&r->pool, blur_band, f, rf_bands(&r->view));
    if (!layers)
        rf_pool_run(&r->pool, range_band, f, rf_bands(&r->view));
}

static void thin_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = rf_renderer_of(f);

    (void)worker;
    if (!rf_thin_patch_band(&f->thin, band))
        return;
    rf_extend_rows(&r->view, r->blur.at, r->blur.stride, rf_band_start(band),
                   rf_band_end(&r->view, band));
    rf_cell_rows(&r->exec, &r->view, r->blur, &r->cells, band);
    rf_bin_tiles(&r->view, f->scale, r->blur, &r->cells, r->bins, band);
}

void rf_pass_thin(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    rf_plane_read(&r->lifetimes, RF_PLANE_CELLS);
    rf_thin_separate(&f->thin);
    rf_pool_run(&r->pool, thin_band, f, rf_bands(&r->view));
    if (!f->thin.disc_scale)
        return;
    rf_plane_begin(&r->lifetimes, RF_PLANE_COVERAGE_SOURCES);
    rf_coverage_splat(&f->thin);
}

void rf_pass_smooth(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    rf_plane_read(&r->lifetimes, RF_PLANE_CELLS);
    mark_highlights(f);
    rf_pool_run(&r->pool, range_band, f, rf_bands(&r->view));
    if (r->yuv->on)
        rf_pool_run(&r->pool, chroma_blur_band, f, rf_bands(&r->view));
    rf_pass_prefilter(f);
}

/* The light whose brightest channel weighs what the search sees. */
static struct rf_light_q12 weighed_by_search(const struct rf_frame *f)
{
    struct rf_light_q12 light = rf_searched_light(f);

    if (f->yuv->on)
        light.channel[1] = light.channel[2] = light.channel[0];
    return light;
}

static void weigh_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    const struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_weights pass = {
        .light_weight = r->light_weight,
        .smooth = rf_is_sweep(f) ? r->smooth : weighed_by_search(f),
        .has_background = rf_is_sweep(f),
        .background = r->background.light,
        .weight = f->weight,
        .background_weight = r->background_weight,
        .is_luminance = r->yuv->on && rf_is_sweep(f),
    };

    (void)worker;
    rf_weigh_rows(&r->view, &pass, band);
}

static void expand_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    const struct refocus_renderer *r = rf_renderer_of(f);
    const int y0 = rf_band_start(band), y1 = rf_band_end(&r->view, band);
    const size_t row = (size_t)r->view.width * sizeof(uint16_t);

    (void)worker;
    if (!rf_searches_subtracted(f)) {
        for (int y = y0; y < y1; y++)
            memcpy(r->smooth.channel[0] + y * r->smooth.stride,
                   r->light.channel[0] + y * r->light.stride, row);
        rf_extend_rows(&r->view, r->smooth.channel[0], r->smooth.stride, y0, y1);
    }
    rf_expand_chroma_rows(&r->view, &r->chroma.size, r->chroma.light, r->smooth, y0, y1);
}

static void expand_background(void *context, int item, int worker)
{
    const struct refocus_renderer *r = context;

    (void)item;
    (void)worker;
    rf_expand_chroma_rows(&r->view, &r->chroma.size, r->chroma.background, r->background.light, 0,
                          r->view.height);
}

void rf_pass_expand_chroma(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    r->cache = (struct rf_pass_cache){0};
    rf_plane_begin(&r->lifetimes, RF_PLANE_SMOOTH);
    rf_pool_run(&r->pool, expand_band, f, rf_bands(&r->view));
    if (f->params->background)
        rf_pool_run(&r->pool, expand_background, r, 1);
}

void rf_pass_weights(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    if (rf_is_sweep(f)) {
        rf_plane_read(&r->lifetimes, RF_PLANE_SMOOTH);
        rf_plane_read(&r->lifetimes, RF_PLANE_BACKGROUND_LIGHT);
        rf_plane_begin(&r->lifetimes, RF_PLANE_BACKGROUND_WEIGHT);
        rf_plane_begin(&r->lifetimes, RF_PLANE_WEIGHT);
    } else {
        rf_plane_begin(&r->lifetimes, RF_PLANE_OWN_WEIGHT);
    }
    rf_pool_run(&r->pool, weigh_band, f, rf_bands(&r->view));
}
