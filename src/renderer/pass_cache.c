/* pass_cache.c: runs the passes that a frame still needs, and keeps what the last one left. */
#include "renderer/passes.h"

#include <limits.h>
#include <string.h>

#include "background/inpaint.h"
#include "passes/linearise.h"
#include "image/viewport.h"
#include "renderer/load.h"
#include "renderer/renderer.h"
#include "thin/thin.h"

static void reblend_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = rf_renderer_of(f);
    uint8_t *blend = &r->photo.band_blend[band];

    if (*blend == f->params->blend)
        return;
    if (r->yuv->on)
        rf_reload_yuv_rows(r, rf_band_start(band), rf_band_end(&r->view, band), worker);
    else
        rf_reblend_rows(&r->view, &r->transfer[*blend], &r->transfer[f->params->blend], r->light,
                        rf_band_start(band), rf_band_end(&r->view, band));
    *blend = (uint8_t)f->params->blend;
}

static bool contains(struct rf_rect a, struct rf_rect b)
{
    return a.x0 <= b.x0 && a.y0 <= b.y0 && a.x1 >= b.x1 && a.y1 >= b.y1;
}

bool rf_same_lens(const struct rf_frame *f)
{
    const struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    return m->blur && !memcmp(&m->plan, &f->plan, sizeof m->plan) && m->shift == f->scale.shift;
}

bool rf_same_light(const struct rf_frame *f)
{
    const struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    return m->smooth && m->blend == f->params->blend && m->gain == rf_gathered_gain(f) &&
           m->splatted == f->splats &&
           ((!m->gathered && !m->splatted) || m->rays == f->params->rays) &&
           !memcmp(m->prefilter_above, f->prefilter_above, sizeof m->prefilter_above);
}

void rf_note_light(struct rf_frame *f)
{
    struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    m->blend = f->params->blend;
    m->gain = rf_gathered_gain(f);
    m->splatted = f->splats;
    m->gathered = m->gain > 1 || f->bright != RF_WHITE;
    m->bright = f->bright;
    m->rays = f->params->rays;
    memcpy(m->prefilter_above, f->prefilter_above, sizeof m->prefilter_above);
}

/* The parts of the photo that a region needs. */
struct parts {
    struct rf_rect visible; /* where its rays go, in whole cells: needs the hidden background */
    struct rf_rect bins;    /* tiles that may reach it: need bins */
};

/* The value of r->cache.thin for this frame: 0, or the size of discs, whether there are mattes, and
 * the blend. */
static uint32_t thin_key(const struct rf_frame *f)
{
    return rf_thin_is_separated(&f->thin)
               ? (uint32_t)f->thin.disc_scale << 8 | (uint32_t)f->thin.mattes << 7 |
                     (uint32_t)f->thin.finds << 6 | (1 + rf_renderer_of(f)->blend)
               : 0;
}

static bool has_same_thin(const struct rf_frame *f)
{
    const struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    return m->thin == thin_key(f) &&
           (!rf_thin_is_separated(&f->thin) || m->splat_blur == f->thin.splat_blur);
}

/* Whether all results that these parts need are there. */
static bool is_there(const struct rf_frame *f, const struct parts *parts, bool layers)
{
    const struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    return rf_same_lens(f) && contains(m->window, parts->bins) && has_same_thin(f) &&
           (layers ? m->background && rf_same_light(f) && contains(m->exact, parts->visible) &&
                         (!m->weighted || rf_is_sweep(f))
                   : !m->silhouettes);
}

/* Computes blur, bins and silhouettes of the window, as far as they are not there. */
static void make_blur(struct rf_frame *f, bool layers)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_pass_cache *m = &r->cache;
    const struct rf_rect window = {r->view.x0, r->view.y0, r->view.x0 + r->view.width,
                                   r->view.y0 + r->view.height};

    if (!rf_same_lens(f) || !contains(m->window, window) || !contains(window, m->window) ||
        !has_same_thin(f) || (m->silhouettes && !layers) ||
        (layers && !rf_same_light(f) &&
         (m->gathered || m->splatted || f->params->highlight_gain > 1))) {
        *m = (struct rf_pass_cache){.window = window,
                                    .plan = f->plan,
                                    .shift = f->scale.shift,
                                    .thin = thin_key(f),
                                    .splat_blur = f->thin.splat_blur,
                                    .textured = f->textured};
        rf_pass_blur(f, layers);
        if (rf_thin_is_separated(&f->thin) && !rf_cancelled(&r->exec))
            rf_pass_thin(f);
        m->blur = !rf_cancelled(&r->exec);
    }
    if (m->blur && layers && !m->silhouettes) {
        m->blur = false; /* until all of them are patched in */
        rf_pass_silhouettes(f);
        m->blur = m->silhouettes = !rf_cancelled(&r->exec);
    }
}

/* Computes the smooth light, unless it is there. Highlights change the blur: they are marked only
 * in blur that is new, see make_blur(). */
static void make_smooth(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_pass_cache *m = &r->cache;

    if (rf_same_light(f)) {
        f->bright = m->bright;
        return;
    }
    m->smooth = m->background = false;
    m->gathered = rf_gathered_gain(f) > 1;
    if (m->ranges) {
        f->bright = RF_WHITE;
        rf_pass_prefilter(f);
    } else {
        rf_pass_smooth(f);
        m->ranges = !rf_cancelled(&r->exec);
        m->blur = m->ranges; /* a cancelled pass may have lost its cells */
    }
    rf_note_light(f);
    m->smooth = !rf_cancelled(&r->exec);
}

/* The distance beyond a tile within which a thick surface decides how thin structures in the tile
 * are drawn. */
static int thin_margin(const struct rf_frame *f)
{
    return rf_thin_is_separated(&f->thin) ? rf_renderer_of(f)->view.pad + 2 * RF_TILE : 0;
}

/* How far the steps of the pre-filter look together, and some. */
static int filter_margin(const struct rf_frame *f)
{
    return 1 << rf_prefilter_most_steps(f->params->max_blur_radius);
}

/* The part of the window where the mark and the smooth light are the same as for the whole photo.
 * It is the reach of a cone and of the steps of the pre-filter away from the window's sides;
 * at the photo's own sides nothing is lost. */
static struct rf_rect sure_part(const struct rf_frame *f)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_photo *photo = &r->photo;
    const int margin = 2 * r->view.pad + filter_margin(f) + thin_margin(f);

    return (struct rf_rect){
        r->view.x0 ? margin : 0,
        r->view.y0 ? margin : 0,
        r->view.x0 + r->view.width < photo->width ? r->view.width - margin : INT_MAX,
        r->view.y0 + r->view.height < photo->height ? r->view.height - margin : INT_MAX,
    };
}

/* Computes the hidden background of the window. Returns true if `visible` has the same background
 * as it has for the whole photo. */
static bool make_background(struct rf_frame *f, struct rf_rect visible)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_pass_cache *m = &r->cache;

    if (m->background && contains(m->exact, visible) && (!m->weighted || rf_is_sweep(f)))
        return true;
    m->background = false;
    rf_pass_mark_background(f, r->pyramid.levels);
    if (rf_cancelled(&r->exec))
        return false;
    if (!contains(m->window, rf_whole(r)) &&
        !rf_background_is_exact(&r->view, &r->pyramid, rf_part_in_window(&r->view, visible),
                                sure_part(f)))
        return false;
    m->exact = contains(m->window, rf_whole(r)) ? m->window : visible;
    rf_pass_inpaint(f, r->pyramid.levels);
    m->background = !rf_cancelled(&r->exec);
    m->weighted = false;
    return m->background;
}

static int floor_to(int v, int step)
{
    return v < 0 ? 0 : v / step * step;
}

static int ceil_to(int v, int step, int most)
{
    return v > most - step ? most : (v + step - 1) / step * step;
}

/* A part of the photo, grown by so many pixels each way and then to multiples of `step`. */
static struct rf_rect grown(const struct refocus_renderer *r, struct rf_rect part, int by, int step)
{
    const struct rf_photo *photo = &r->photo;

    return (struct rf_rect){floor_to(part.x0 - by, step), floor_to(part.y0 - by, step),
                            ceil_to(part.x1 + by, step, photo->width),
                            ceil_to(part.y1 + by, step, photo->height)};
}

/* Whether a window is so large that it saves nothing over the whole photo. */
static bool is_large(const struct refocus_renderer *r, struct rf_rect window)
{
    const struct rf_rect all = rf_whole(r);
    const int64_t part = (int64_t)(window.x1 - window.x0) * (window.y1 - window.y0);

    return 10 * part > 7 * (int64_t)all.x1 * all.y1;
}

static struct rf_rect around_both(struct rf_rect a, struct rf_rect b)
{
    return (struct rf_rect){a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0,
                            a.x1 > b.x1 ? a.x1 : b.x1, a.y1 > b.y1 ? a.y1 : b.y1};
}

static void make_in_window(struct rf_frame *f, const struct parts *parts, bool layers)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_rect all = rf_whole(r);
    struct rf_rect window = parts->bins;
    int around = 2 * r->view.pad, step = RF_TILE;

    if (rf_same_lens(f) && contains(r->cache.window, all))
        window = all; /* much of it is there already */
    for (;;) {
        if (layers && !contains(window, all)) {
            while (step < around / 2)
                step *= 2;
            window = grown(r, parts->visible,
                           2 * r->view.pad + filter_margin(f) + thin_margin(f) + around, step);
            window = around_both(window, grown(r, parts->bins, 0, step));
        }
        if (is_large(r, window))
            window = all;
        rf_use(r, window);
        rf_set_planes(f);
        make_blur(f, layers);
        if (!layers || rf_cancelled(&r->exec))
            return;
        make_smooth(f);
        if (rf_cancelled(&r->exec) || make_background(f, parts->visible) || rf_cancelled(&r->exec))
            return;
        around *= 2;
    }
}

/* Computes the weights, which overwrite the background's blur: the sweep reads that from the bins.
 */
static void make_weights(struct rf_frame *f)
{
    struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    if (rf_cancelled(&rf_renderer_of(f)->exec) || (m->weighted && m->sigma == f->params->sigma))
        return;
    m->weighted = true;
    m->sigma = -1; /* until all of them are there */
    rf_pass_weights(f);
    if (!rf_cancelled(&rf_renderer_of(f)->exec))
        m->sigma = f->params->sigma;
}

/* Computes the weights of the photo's own light, in place of those of the sweep. */
static void make_own_weights(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_pass_cache *m = &r->cache;

    if (rf_cancelled(&r->exec) ||
        (rf_plane_lives(&r->lifetimes, RF_PLANE_OWN_WEIGHT) && m->own_sigma == f->params->sigma &&
         m->own_blend == f->params->blend && !rf_searches_subtracted(f)))
        return;
    m->sigma = m->own_sigma = -1;
    rf_pass_weights(f);
    m->own_blend = f->params->blend;
    if (!rf_cancelled(&r->exec) && !rf_searches_subtracted(f))
        m->own_sigma = f->params->sigma;
}

/* Finds thin structures, in a window that is all of the photo. */
static void find_thin(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    if (rf_thin_is_separated(&f->thin) && r->photo.thin.has_matte)
        rf_matte_reblend(&f->thin, r->transfer, r->blend);
    if (f->thin.finds && r->photo.thin.blend != r->blend)
        rf_thin_find(&f->thin, r->blend);
}

void rf_run_passes(struct rf_frame *f, struct rf_rect region, enum rf_need need, bool whole)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const bool layers = need == RF_NEED_LAYERS;
    struct parts parts = {rf_whole(r), rf_whole(r)};

    rf_use(r, rf_whole(r));
    rf_set_planes(f);
    f->region = region;
    if (r->yuv->on)
        rf_yuv_set_blend(r->yuv, f->params->blend);
    rf_pool_run(&r->pool, reblend_band, f, rf_bands(&r->view));
    if (rf_cancelled(&r->exec))
        return;
    r->blend = f->params->blend;
    rf_set_weights(f);
    if (layers)
        rf_pass_highlights(f);
    if (!rf_cancelled(&r->exec))
        find_thin(f);
    if (need == RF_NEED_LIGHT || rf_cancelled(&r->exec))
        return;
    if (!whole) {
        parts.visible = grown(r, grown(r, region, 0, RF_TILE), r->view.pad + RF_CELL, 1);
        parts.bins = grown(r, region,
                           r->view.pad + 2 * RF_TILE + thin_margin(f) +
                               (f->focus.unit ? RF_BLOCK * RF_TILE : 0),
                           RF_TILE);
    }
    if (r->cache.textured != f->textured) /* smooth light has texture, too, behind thin things */
        r->cache = (struct rf_pass_cache){0};
    if (is_there(f, &parts, layers)) {
        rf_use(r, r->cache.window);
        rf_set_planes(f);
        f->bright = layers ? r->cache.bright : RF_WHITE;
    } else {
        /* The background is inpainted from smooth light that is not boosted. */
        if (r->cache.boosted)
            r->cache = (struct rf_pass_cache){0};
        make_in_window(f, &parts, layers);
    }
    if (layers && !rf_cancelled(&r->exec) && !r->cache.boosted && rf_boosts(f)) {
        rf_pass_boost(f);
        r->cache.boosted = true;
        if (rf_cancelled(&r->exec)) /* light that is boosted in part cannot be boosted again */
            r->cache = (struct rf_pass_cache){0};
    }
    if (layers && f->weighted && rf_is_sweep(f))
        make_weights(f);
    if (r->yuv->on && rf_is_search(f) && !rf_cancelled(&r->exec))
        rf_pass_expand_chroma(f);
    if (f->weighted && rf_is_search(f))
        make_own_weights(f);
    f->region = rf_part_in_window(&r->view, region);
}
