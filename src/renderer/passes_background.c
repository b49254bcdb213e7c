/* passes_background.c: the passes of the hidden background: marked and pushed, then inpainted. */
#include "background/behind.h"
#include "background/inpaint.h"
#include "background/mark.h"
#include "highlights/highlights.h"
#include "highlights/known.h"
#include "renderer/passes.h"
#include "renderer/renderer.h"
#include "support/compare.h"
#include "thin/thin.h"
#include "tiles/ranges.h"

struct mark {
    const struct refocus_renderer *r;
    struct rf_mark pass;
    const struct rf_behind_pass *behind;     /* NULL: the scene has none */
    const struct rf_thin_pass *thin;         /* NULL: it hides nothing */
    const struct rf_highlight_window *known; /* NULL: no light above white is known */
    const struct rf_focus_plan *plan;
    int levels;
};

/* The window, if the photo has light above white; else NULL. */
static const struct rf_highlight_window *known_of(const struct rf_frame *f)
{
    return f->splat.window.known && f->bright != RF_WHITE ? &f->splat.window : NULL;
}

static void push_band(const struct mark *mark, int band)
{
    const struct refocus_renderer *r = mark->r;

    rf_background_push_band(&r->exec, &r->pyramid, band, 0, rf_smaller(mark->levels, 1));
    if (mark->known)
        rf_push_known(mark->known, mark->plan, r->disparity, &r->pyramid, band);
    rf_background_push_band(&r->exec, &r->pyramid, band, 1, mark->levels);
}

static void dilate_item(void *context, int upwards, int worker)
{
    const struct mark *mark = context;

    (void)worker;
    rf_background_dilate(&mark->r->exec, &mark->r->view, &mark->pass, upwards);
}

static void mark_band(void *context, int band, int worker)
{
    const struct mark *mark = context;
    const struct refocus_renderer *r = mark->r;

    rf_background_mark_rows(&r->exec, &r->view, &mark->pass, rf_band_start(band),
                            rf_band_end(&r->view, band), worker);
    rf_background_leave_mixed(&r->view, &mark->pass, band);
    if (mark->thin)
        rf_thin_hide(mark->thin, r->background.blur, band);
    if (mark->behind)
        rf_behind_rows(&r->exec, &r->view, mark->behind, rf_band_start(band),
                       rf_band_end(&r->view, band), worker);
    if (!r->yuv->on)
        push_band(mark, band);
}

static void mark_and_push(struct refocus_renderer *r, struct mark *mark)
{
    rf_plane_begin(&r->lifetimes, RF_PLANE_CONE);
    rf_plane_begin(&r->lifetimes, RF_PLANE_BACKGROUND_BLUR);
    rf_plane_begin(&r->lifetimes, RF_PLANE_PYRAMID);
    rf_pool_run(r->exec.pool, dilate_item, mark, 2);
    /* Each row of the cone is read before the background's light is written over it. */
    rf_plane_begin(&r->lifetimes, RF_PLANE_BACKGROUND_LIGHT);
    rf_pool_run(r->exec.pool, mark_band, mark, rf_bands(&r->view));
    if (!r->yuv->on)
        rf_background_push(&r->exec, &r->pyramid, RF_BAND_LEVELS, mark->levels);
}

void rf_pass_mark_background(struct rf_frame *f, int levels)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const int16_t apart = rf_layers_apart(f->params->max_blur_radius, f->focus.unit);
    const struct rf_behind_pass behind = {.behind = &r->photo.behind,
                                          .transfer = &r->transfer[r->blend],
                                          .plan = &f->plan,
                                          .above = f->prefilter_above,
                                          .steps = RF_PREFILTER_STEPS,
                                          .disparity = r->disparity,
                                          .blur = r->blur,
                                          .apart = apart,
                                          .background = r->background};
    struct mark mark = {.r = r,
                        .behind = r->photo.behind.width ? &behind : NULL,
                        .thin = f->textured && f->thin.disc_scale ? &f->thin : NULL,
                        .known = known_of(f),
                        .plan = &f->plan,
                        .pass = {.planes = r->yuv->on ? 1 : 3,
                                 .reach = rf_mark_reach(f->plan.plain, r->view.pad, f->focus.unit),
                                 .blur = r->blur,
                                 .smooth = r->smooth,
                                 .bins = r->bins,
                                 .cone = r->cone,
                                 .background = r->background},
                        .levels = levels};

    r->pyramid.apart = apart;
    rf_plane_read(&r->lifetimes, RF_PLANE_BLUR);
    rf_plane_read(&r->lifetimes, RF_PLANE_SMOOTH);
    mark_and_push(r, &mark);
    if (mark.thin && !rf_cancelled(&r->exec) && r->pyramid.level[levels].blur.at[0] == RF_NO_BLUR) {
        rf_thin_hide_none(&f->thin); /* all that is known lies behind thin structures */
        mark.thin = NULL;
        mark_and_push(r, &mark);
    }
}

static void note_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = rf_renderer_of(f);

    (void)worker;
    if (known_of(f))
        rf_note_behind(&r->exec, known_of(f), r->background.light, band);
    rf_note_background_blur(&r->view, r->background.blur, r->bins, band);
    rf_foreground_rows(&r->exec, &r->view, r->blur, r->background.blur, &r->foreground, band);
}

static void bare_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    const struct rf_range_pass pass = {r->cells, r->foreground, r->yuv->on, r->range};

    rf_mark_ranges_in_background(&r->exec, &r->view, &pass, band, worker);
}

/* Blurs of one surface differ by 1/24 of the largest one, or a pixel; as they are stored. */
static int same_surface(const struct rf_frame *f)
{
    const int unit = f->focus.unit;

    return rf_larger((int)(f->params->max_blur_radius * (256.0f / 24)), 256) >> unit;
}

static void take_filled_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    rf_thin_take_filled(&f->thin, rf_renderer_of(f)->background, band);
}

/* Thin structures that are splatted lie over the smooth light: what they hide is there. */
static void pull_textured(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    rf_background_pull_textured(&r->exec, &r->view, &r->pyramid,
                                &(struct rf_texture){.scratch = r->texture,
                                                     .transfer = &r->transfer[r->blend],
                                                     .same = same_surface(f),
                                                     .unit = f->focus.unit});
    if (f->thin.disc_scale)
        rf_pool_run(&r->pool, take_filled_band, f, rf_bands(&r->view));
}

void rf_pass_inpaint(struct rf_frame *f, int levels)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    rf_plane_read(&r->lifetimes, RF_PLANE_PYRAMID);
    rf_plane_read(&r->lifetimes, RF_PLANE_BACKGROUND_BLUR);
    if (r->yuv->on)
        rf_background_inpaint_yuv(
            &r->exec, &r->view, &r->pyramid,
            &(struct rf_inpaint_chroma){r->chroma.size, r->chroma.smooth, r->chroma.background});
    else if (f->textured)
        pull_textured(f);
    else
        rf_background_pull(&r->exec, &r->view, &r->pyramid, 0, levels);
    rf_plane_begin(&r->lifetimes, RF_PLANE_FOREGROUND);
    rf_pool_run(&r->pool, note_band, f, rf_bands(&r->view));
    if (f->bright != RF_WHITE && !f->splats)
        rf_raise_highlights(f->exec, &f->splat.window, &r->foreground, rf_ray_gap(f->params->rays));
    if (f->bright != RF_WHITE && rf_leaves_known(&f->splat.window))
        rf_raise_known(f->exec, &f->splat.window, &r->foreground);
    rf_pool_run(&r->pool, bare_band, r, rf_bands(&r->view));
}
