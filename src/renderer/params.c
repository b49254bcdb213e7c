/* params.c: says which settings a renderer cannot render, or which do not go together. */
#include "renderer/params.h"

#include "aperture/aperture.h"
#include "image/format.h"
#include "renderer/methods.h"

static bool has_sides(const struct rf_settings *s)
{
    return s->aperture && rf_aperture_has_sides(s->aperture);
}

static bool is_plain_focus(const struct refocus_renderer *r, const struct rf_settings *s)
{
    struct rf_focus_plan plan;

    rf_focus_plan_make(&plan, s, rf_focus_of(s->focus_disparity, s->max_blur_radius),
                       r->photo.width, r->photo.height);
    return plan.plain;
}

/* Words for a setting that the method refuses, or NULL. */
static const char *refused(const struct refocus_renderer *r, const struct rf_settings *s)
{
    const uint32_t traits = refocus_method_traits(s->method);
    const bool sweep = s->method == REFOCUS_METHOD_SWEEP;

    if (!sweep && s->cat_eye > 0)
        return "look->cat_eye, which belongs to the sweep";
    if (!sweep && s->fringe != 0)
        return "look->fringe, which belongs to the sweep";
    if (!sweep && has_sides(s))
        return "an aperture that differs before and behind the focus, which belongs to the sweep";
    if ((traits & REFOCUS_METHOD_DISC_ONLY) && s->aperture && !rf_aperture_is_disc(s->aperture))
        return "an aperture other than a disc";
    if (!(traits & REFOCUS_METHOD_ANY_RADIUS) && s->max_blur_radius > RF_PLAIN_RADIUS)
        return "a max_blur_radius of more than 127";
    if (!(traits & REFOCUS_METHOD_ANY_FOCUS) && !is_plain_focus(r, s))
        return "focus or field other than that of a plain lens";
    return NULL;
}

int rf_check_settings(const struct rf_log *log, const struct refocus_renderer *r,
                      const struct rf_settings *s)
{
    const char *what;

    if (!(r->methods & REFOCUS_METHOD_BIT(s->method)))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "method is %u, %s, which the renderer was not made for",
                         (unsigned)s->method, refocus_method_name(s->method));
    if (s->max_blur_radius > r->max_blur_radius)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "max_blur_radius is %.9g, may be 0 to the renderer's %.9g",
                         (double)s->max_blur_radius, (double)r->max_blur_radius);
    if (has_sides(s) && s->rays == REFOCUS_RAYS_FULL)
        return rf_refuse(
            log, REFOCUS_ERR_ARGUMENT,
            "rays is %d, may be 1 to %d with an aperture that differs before and behind the focus",
            REFOCUS_RAYS_FULL, REFOCUS_MAX_RAYS);
    what = refused(r, s);
    return what ? rf_refuse(log, REFOCUS_ERR_ARGUMENT, "method is %u, %s, which refuses %s",
                            (unsigned)s->method, refocus_method_name(s->method), what)
                : REFOCUS_OK;
}

/* Whether the look is one that only photos of R, G and B can have. */
static bool has_look(const struct rf_frame *f)
{
    const struct rf_settings *p = f->params;

    return p->cat_eye > 0 || p->fringe != 0 || p->grain > 0 ||
           (p->star_spikes > 0 && p->star_strength > 0) || has_sides(p);
}

/* Whether a region begins, and within the photo ends, between samples of chroma. */
static bool keeps_pairs(struct rf_rect region, int width, int height, int odd_rows)
{
    return !(region.x0 % 2 || (region.x1 % 2 && region.x1 < width) || (region.y0 & odd_rows) ||
             ((region.y1 & odd_rows) && region.y1 < height));
}

static int refuse_split(const struct rf_log *log, struct rf_rect region)
{
    return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                     "region is from (%d, %d) to (%d, %d), may not split samples of U and V",
                     region.x0, region.y0, region.x1, region.y1);
}

int rf_check_deep(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_settings *p = f->params;

    if (!r->deep.on && !rf_is_deep(f->out->format))
        return REFOCUS_OK;
    if (!r->deep.curve || r->yuv->on ||
        !(refocus_method_traits(p->method) & REFOCUS_METHOD_TAKES_DEEP) ||
        p->blend != REFOCUS_BLEND_LINEAR || p->sigma < 1e6f || p->grain > 0 ||
        (p->star_spikes > 0 && p->star_strength > 0))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "a deep photo or out needs deep = 1 of the renderer's parameters, and is "
                         "rendered by sweep, search, blur and interpolated, R, G, B or P010, P016, "
                         "in linear light, without sigma, grain, stars and in_place");
    if (refocus_format_is_yuv(f->out->format) &&
        !keeps_pairs(region, r->photo.width, r->photo.height, 1))
        return refuse_split(log, region);
    return REFOCUS_OK;
}

int rf_check_yuv(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    const int odd_rows = r->yuv->down ? 1 : 0;

    if (rf_is_yuv8(f->out->format) != r->yuv->on)
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED, "out->format is %u, may be one of %s",
                         (unsigned)f->out->format, r->yuv->on ? "Y, U and V" : "R, G and B");
    if (!r->yuv->on)
        return REFOCUS_OK;
    if (rf_chroma_down(f->out->format) != r->yuv->down ||
        !rf_method_of(r->papers, f->params->method)->yuv_tile || has_look(f))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "a photo of Y, U and V is rendered by sweep or search, without cat's eye, "
                         "fringe, grain, stars and two-sided apertures, into its own sampling");
    return keeps_pairs(region, r->photo.width, r->photo.height, odd_rows)
               ? REFOCUS_OK
               : refuse_split(log, region);
}
