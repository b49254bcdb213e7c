/* settings.c: reads the public parameters of a render, one struct a feature, into one flat struct,
 * and says which of them is out of its range. */
#include "renderer/settings.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include <refocus/settings.h>

#include "aperture/aperture.h"
#include "highlights/highlights.h"
#include "image/read.h"
#include "support/rules.h"

/* Each struct of a feature: where its pointer and its place among all of them are, and how large
 * its first layout was. A struct that ends in padding could not tell a new field from it. */
#define FEATURE(type, member, last)                                                                \
    {                                                                                              \
#member, offsetof(struct refocus_render_params, member),                                   \
            offsetof(struct refocus_settings, member), sizeof(struct type),                        \
            REFOCUS_SIZE_TO(struct type, last)                                                     \
    }

static const struct feature {
    const char *name;
    size_t pointer, place, size, first;
} features[] = {
    FEATURE(refocus_highlight_params, highlights, gain),
    FEATURE(refocus_thin_params, thin, enabled),
    FEATURE(refocus_look_params, look, star_strength),
    FEATURE(refocus_focus_params, focus, reserved),
    FEATURE(refocus_field_params, field, map),
    FEATURE(refocus_search_params, search, background),
    FEATURE(refocus_jittered_params, jittered, seed),
    FEATURE(refocus_scatter_params, scatter, depth_ratio),
    FEATURE(refocus_interpolated_params, interpolated, last_ratio),
    FEATURE(refocus_foveated_params, foveated, depth),
    FEATURE(refocus_diffusion_params, diffusion, conductivity),
};

/* A field that is a number: where it is among all features and in struct rf_settings. Names of
 * features are said, that of the struct they hang on is not. */
struct row {
    struct rf_rule rule; /* the offset is in struct refocus_settings */
    size_t to;
};

#define AT(group, field) offsetof(struct refocus_settings, group.field)
#define RENDER(type, field, least, most)                                                           \
    {                                                                                              \
        RF_RULE(#field, AT(render, field), type, least, most), offsetof(struct rf_settings, field) \
    }
#define ROW(type, group, field, member, least, most)                                               \
    {                                                                                              \
        RF_RULE(#group "->" #field, AT(group, field), type, least, most),                          \
            offsetof(struct rf_settings, member)                                                   \
    }
#define OR(type, group, field, member, above, least, most, other)                                  \
    {                                                                                              \
        {#group "->" #field, AT(group, field), type, above, true, least, most, other},             \
            offsetof(struct rf_settings, member)                                                   \
    }

static const struct row rows[] = {
    RENDER(RF_UNSIGNED, method, 0, REFOCUS_METHOD_COUNT - 1),
    RENDER(RF_REAL, focus_disparity, 0, 1),
    RENDER(RF_REAL, max_blur_radius, 0, REFOCUS_MAX_BLUR_RADIUS),
    {{"rays", AT(render, rays), RF_SIGNED, false, true, 1, REFOCUS_MAX_RAYS, REFOCUS_RAYS_FULL},
     offsetof(struct rf_settings, rays)},
    RENDER(RF_UNSIGNED, blend, 0, REFOCUS_BLEND_GAMMA),
    RENDER(RF_REAL, sigma, 1, INFINITY),
    RENDER(RF_UNSIGNED, prefilter, 0, 1),
    RENDER(RF_UNSIGNED, inpaint, 0, REFOCUS_INPAINT_COUNT - 1),
    RENDER(RF_UNSIGNED, dither, 0, REFOCUS_DITHER_OFF),
    RENDER(RF_SIGNED, region_x, INT32_MIN, INT32_MAX),
    RENDER(RF_SIGNED, region_y, INT32_MIN, INT32_MAX),
    RENDER(RF_SIGNED, region_width, INT32_MIN, INT32_MAX),
    RENDER(RF_SIGNED, region_height, INT32_MIN, INT32_MAX),
    ROW(RF_REAL, highlights, gain, highlight_gain, 1, RF_MOST_GAIN),
    ROW(RF_REAL, highlights, estimate, highlight_estimate, 0, 4),
    ROW(RF_REAL, highlights, steady, highlight_steady, 0, 0.95),
    ROW(RF_UNSIGNED, thin, enabled, thin, 0, 1),
    ROW(RF_REAL, look, cat_eye, cat_eye, 0, 0.9),
    ROW(RF_REAL, look, fringe, fringe, -0.5, 0.5),
    ROW(RF_REAL, look, grain, grain, 0, 4),
    ROW(RF_UNSIGNED, look, grain_seed, grain_seed, 0, UINT32_MAX),
    OR(RF_SIGNED, look, star_spikes, star_spikes, false, 2, 16, 0),
    ROW(RF_REAL, look, star_length, star_length, 0, REFOCUS_PLAIN_BLUR_RADIUS),
    ROW(RF_REAL, look, star_angle, star_angle, -3600, 3600),
    ROW(RF_REAL, look, star_strength, star_strength, 0, 1),
    ROW(RF_REAL, focus, tilt_x, tilt_x, 0, 1),
    ROW(RF_REAL, focus, tilt_y, tilt_y, 0, 1),
    ROW(RF_REAL, focus, tilt_across, tilt_across, -REFOCUS_MAX_TILT, REFOCUS_MAX_TILT),
    ROW(RF_REAL, focus, tilt_down, tilt_down, -REFOCUS_MAX_TILT, REFOCUS_MAX_TILT),
    ROW(RF_REAL, focus, depth_share, depth_share, 0, 1),
    ROW(RF_REAL, focus, half_width, focus_half_width, 0, 1),
    ROW(RF_REAL, focus, transition, focus_transition, 0, 1),
    ROW(RF_REAL, focus, least_disparity, least_disparity, 0, 1),
    ROW(RF_REAL, focus, most_disparity, most_disparity, 0, 1),
    ROW(RF_REAL, focus, blur_limit, blur_limit, 0, REFOCUS_MAX_BLUR_RADIUS),
    ROW(RF_SIGNED, focus, bands, bands, 0, REFOCUS_MAX_BANDS - 1),
    ROW(RF_UNSIGNED, field, shape, field, 0, REFOCUS_FIELD_PICTURE),
    ROW(RF_REAL, field, x, field_x, 0, 1),
    ROW(RF_REAL, field, y, field_y, 0, 1),
    ROW(RF_REAL, field, disparity, field_disparity, 0, 1),
    ROW(RF_REAL, field, radius, field_radius, 0, 4),
    ROW(RF_REAL, field, falloff, field_falloff, 0.001, 4),
    ROW(RF_REAL, field, angle, field_angle, -3600, 3600),
    ROW(RF_SIGNED, search, iterations, iterations, 1, 64),
    ROW(RF_UNSIGNED, search, mirror, mirror, 0, 1),
    ROW(RF_UNSIGNED, search, background, background, 0, 1),
    ROW(RF_SIGNED, jittered, cell, cell, 1, 16),
    ROW(RF_UNSIGNED, jittered, seed, seed, 0, UINT32_MAX),
    ROW(RF_UNSIGNED, scatter, spread, spread, 0, REFOCUS_SPREAD_LOMMEL),
    ROW(RF_REAL, scatter, airy_radius, airy_radius, 0.25, 16),
    ROW(RF_REAL, scatter, depth_ratio, depth_ratio, 1, 1000),
    ROW(RF_REAL, interpolated, sharp_radius, sharp_radius, 0.5, 16),
    OR(RF_REAL, interpolated, middle_ratio, middle_ratio, true, 1, 1000, 0),
    OR(RF_REAL, interpolated, last_ratio, last_ratio, true, 1, 1000, 0),
    ROW(RF_REAL, foveated, x, attention_x, 0, 1),
    ROW(RF_REAL, foveated, y, attention_y, 0, 1),
    ROW(RF_REAL, foveated, angle, attention_angle, 0, 170),
    ROW(RF_REAL, foveated, picture_angle, picture_angle, 1, 170),
    ROW(RF_REAL, foveated, depth, attention_depth, 0, 1),
    ROW(RF_SIGNED, diffusion, layers, layers, 1, 8),
    ROW(RF_UNSIGNED, diffusion, solver, solver, 0, REFOCUS_SOLVER_ITERATED),
    ROW(RF_REAL, diffusion, conductivity, conductivity, 0.01, 1),
};

/* All features, with their defaults where the caller has none. */
static int read_all(const struct rf_log *log, struct refocus_settings *all,
                    const struct refocus_render_params *given)
{
    struct refocus_render_params render;
    int status = rf_read_struct(log, "params", &render, sizeof render,
                                REFOCUS_SIZE_TO(struct refocus_render_params, diffusion), given);

    if (status)
        return status;
    *all = refocus_settings_default(render.focus_disparity, render.max_blur_radius);
    all->render = render;
    for (size_t i = 0; i < sizeof features / sizeof *features; i++) {
        const struct feature *feature = &features[i];
        const void *theirs;

        memcpy(&theirs, (const char *)&render + feature->pointer, sizeof theirs);
        if (!theirs)
            continue;
        status = rf_read_struct(log, feature->name, (char *)all + feature->place, feature->size,
                                feature->first, theirs);
        if (status)
            return status;
    }
    return REFOCUS_OK;
}

static int read_map(const struct rf_log *log, const char *name, struct refocus_disparity *own,
                    const struct refocus_disparity **map, const struct refocus_disparity *given)
{
    *map = given ? own : NULL;
    return given ? rf_read_map(log, name, own, given) : REFOCUS_OK;
}

static int read_maps(const struct rf_log *log, struct rf_settings *s,
                     const struct refocus_settings *all)
{
    int status = read_map(log, "focus->map", &s->own_focus_map, &s->focus_map, all->focus.map);

    if (!status)
        status = read_map(log, "focus->sharp_map", &s->own_sharp_map, &s->sharp_map,
                          all->focus.sharp_map);
    if (!status)
        status = read_map(log, "field->map", &s->own_field_map, &s->field_map, all->field.map);
    if (!status && s->field == REFOCUS_FIELD_PICTURE && !s->field_map)
        status =
            rf_refuse(log, REFOCUS_ERR_ARGUMENT, "field->map is NULL, which field->shape %d needs",
                      REFOCUS_FIELD_PICTURE);
    return status;
}

static int read_bands(const struct rf_log *log, struct rf_settings *s,
                      const struct refocus_focus_params *focus)
{
    memcpy(s->band, focus->band, sizeof s->band);
    if (focus->reserved)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "focus->reserved is %u, may be 0",
                         (unsigned)focus->reserved);
    for (int i = 0; i < s->bands; i++) {
        const float value[] = {s->band[i].disparity, s->band[i].half_width, s->band[i].transition};
        static const char *const name[] = {"disparity", "half_width", "transition"};

        for (int k = 0; k < 3; k++)
            if (!(value[k] >= 0 && value[k] <= 1))
                return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                                 "focus->band[%d].%s is %.9g, may be 0 to 1", i, name[k],
                                 (double)value[k]);
    }
    return REFOCUS_OK;
}

int rf_read_settings(const struct rf_log *log, struct rf_settings *s,
                     const struct refocus_render_params *params)
{
    struct refocus_settings all;
    int status = read_all(log, &all, params);

    memset(s, 0, sizeof *s);
    for (size_t i = 0; !status && i < sizeof rows / sizeof *rows; i++) {
        memcpy((char *)s + rows[i].to, (const char *)&all + rows[i].rule.offset, RF_RULE_BYTES);
        status = rf_check_rule(log, &rows[i].rule, &all);
    }
    if (status)
        return status;
    s->aperture = all.render.aperture;
    if (s->highlight_estimate > 0)
        s->highlight_gain = RF_MOST_GAIN;
    if ((status = read_bands(log, s, &all.focus)) || (status = read_maps(log, s, &all)))
        return status;
    if (s->most_disparity < s->least_disparity)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "focus->most_disparity is %.9g, may be focus->least_disparity, %.9g, to 1",
                         (double)s->most_disparity, (double)s->least_disparity);
    if (s->last_ratio != 0 && s->middle_ratio >= s->last_ratio)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "interpolated->middle_ratio is %.9g, may be below last_ratio, %.9g",
                         (double)s->middle_ratio, (double)s->last_ratio);
    return REFOCUS_OK;
}

void rf_keep_settings(struct rf_settings *kept, const struct rf_settings *settings)
{
    *kept = *settings;
    kept->focus_map = settings->focus_map ? &kept->own_focus_map : NULL;
    kept->sharp_map = settings->sharp_map ? &kept->own_sharp_map : NULL;
    kept->field_map = settings->field_map ? &kept->own_field_map : NULL;
}
