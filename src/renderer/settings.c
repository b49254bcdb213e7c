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

static const struct row rows[] = {
#define FROM(least_, most_)  .least = (least_), .most = (most_)
#define ABOVE(least_, most_) .above = true, FROM(least_, most_)
#define OR(value)            .has_other = true, .other = (value)
#define ROW(type_, group, field, name_, shown, ...)                                                \
    {{.name = (shown),                                                                             \
      .offset = offsetof(struct refocus_settings, group.field),                                    \
      .type = RF_##type_,                                                                          \
      __VA_ARGS__},                                                                                \
     offsetof(struct rf_settings, name_)},
#define RENDER(type, field, ...) ROW(type, render, field, field, #field, __VA_ARGS__)
#define SETTING(type, feature, field, name, ...)                                                   \
    ROW(type, feature, field, name, #feature "->" #field, __VA_ARGS__)
#include "support/settings.def"
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
