#include "renderer/params.h"
#include "renderer/methods.h"

#include "aperture/aperture.h"
#include "image/format.h"

static bool in(double value, double least, double most)
{
    return value >= least && value <= most; /* NaN is in no range */
}

static bool has_round_aperture(const struct refocus_render_params *p)
{
    return !p->aperture || p->aperture->shape == RF_SHAPE_DISC;
}

static bool good_rays(const struct refocus_renderer *r, const struct refocus_render_params *p)
{
    return in(p->focus_disparity, 0, 1) && in(p->max_blur_radius, 0, r->max_blur_radius) &&
           (p->rays == REFOCUS_RAYS_FULL || (p->rays >= 1 && p->rays <= REFOCUS_MAX_RAYS)) &&
           p->blend < RF_BLEND_COUNT && p->sigma >= 1 && p->iterations >= 1 &&
           p->iterations <= 64 && in(p->highlight_gain, 1, RF_MOST_GAIN) && p->mirror <= 1 &&
           p->background <= 1 && p->thin <= 1 && p->prefilter <= 1 && p->reserved == 0 &&
           p->cell >= 1 && p->cell <= 16;
}

static bool good_scatter(const struct refocus_render_params *p)
{
    return p->spread <= REFOCUS_SPREAD_LOMMEL && in(p->airy_radius, 0.25, 16) &&
           in(p->depth_ratio, 1, 1000) &&
           (p->star_spikes == 0 || (p->star_spikes >= 2 && p->star_spikes <= 16)) &&
           in(p->star_length, 0, REFOCUS_MAX_BLUR_RADIUS) && in(p->star_angle, -3600, 3600) &&
           in(p->star_strength, 0, 1);
}

static bool good_ratios(const struct refocus_render_params *p)
{
    const bool own_last = p->last_ratio != 0, own_middle = p->middle_ratio != 0;

    return in(p->sharp_radius, 0.5, 16) &&
           (!own_last || (p->last_ratio > 1 && p->last_ratio <= 1000)) &&
           (!own_middle || (p->middle_ratio > 1 && p->middle_ratio <= 1000)) &&
           !(own_last && own_middle && p->middle_ratio >= p->last_ratio);
}

static bool good_attention(const struct refocus_render_params *p)
{
    return in(p->attention_x, 0, 1) && in(p->attention_y, 0, 1) && in(p->attention_angle, 0, 170) &&
           in(p->picture_angle, 1, 170) && in(p->attention_depth, 0, 1);
}

static bool good_field(const struct refocus_render_params *p)
{
    return p->field <= REFOCUS_FIELD_PICTURE && in(p->field_x, 0, 1) && in(p->field_y, 0, 1) &&
           in(p->field_disparity, 0, 1) && in(p->field_radius, 0, 4) &&
           in(p->field_falloff, 1e-3, 4) && in(p->field_angle, -3600, 3600) && p->layers >= 1 &&
           p->layers <= 8 && p->solver <= REFOCUS_SOLVER_ITERATED && in(p->conductivity, 0.01, 1) &&
           (!p->field_map || rf_good_map(p->field_map)) &&
           (p->field != REFOCUS_FIELD_PICTURE || p->field_map);
}

static bool good_bands(const struct refocus_render_params *p)
{
    if (!in(p->focus_half_width, 0, 1) || !in(p->focus_transition, 0, 1) || p->bands < 0 ||
        p->bands > REFOCUS_MAX_BANDS - 1)
        return false;
    for (int i = 0; i < p->bands; i++)
        if (!in(p->band[i].disparity, 0, 1) || !in(p->band[i].half_width, 0, 1) ||
            !in(p->band[i].transition, 0, 1))
            return false;
    return true;
}

static bool good_focus(const struct refocus_render_params *p)
{
    return in(p->tilt_x, 0, 1) && in(p->tilt_y, 0, 1) &&
           in(p->tilt_across, -REFOCUS_MAX_TILT, REFOCUS_MAX_TILT) &&
           in(p->tilt_down, -REFOCUS_MAX_TILT, REFOCUS_MAX_TILT) && in(p->depth_share, 0, 1) &&
           good_bands(p) && (!p->focus_map || rf_good_map(p->focus_map)) &&
           (!p->sharp_map || rf_good_map(p->sharp_map)) && in(p->least_disparity, 0, 1) &&
           in(p->most_disparity, p->least_disparity, 1) &&
           in(p->blur_limit, 0, REFOCUS_MAX_BLUR_RADIUS);
}

/* What only sweep can render. */
static bool has_own_look(const struct refocus_render_params *p)
{
    return p->cat_eye > 0 || p->fringe != 0 || (p->aperture && rf_aperture_has_sides(p->aperture));
}

static bool good_look(const struct refocus_render_params *p)
{
    return in(p->grain, 0, 4) && in(p->cat_eye, 0, 0.9f) && in(p->fringe, -0.5, 0.5) &&
           (!has_own_look(p) || p->method == REFOCUS_METHOD_SWEEP) &&
           !(p->aperture && rf_aperture_has_sides(p->aperture) && p->rays == REFOCUS_RAYS_FULL);
}

static bool is_plain_focus(const struct refocus_renderer *r, const struct refocus_render_params *p)
{
    struct rf_focus_plan plan;

    rf_focus_plan_make(&plan, p, rf_focus_of(p->focus_disparity, p->max_blur_radius),
                       r->photo.width, r->photo.height);
    return plan.plain;
}

bool rf_good_params(const struct refocus_renderer *r, const struct refocus_render_params *p)
{
    return p && p->struct_size == sizeof *p && p->method < REFOCUS_METHOD_COUNT &&
           (r->methods & REFOCUS_METHOD_BIT(p->method)) && good_rays(r, p) && good_scatter(p) &&
           good_ratios(p) && good_attention(p) && good_field(p) && good_focus(p) && good_look(p) &&
           (rf_method_info(p->method)->any_focus || is_plain_focus(r, p)) &&
           (!rf_method_info(p->method)->disc_only || has_round_aperture(p));
}
