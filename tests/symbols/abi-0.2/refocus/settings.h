/* settings.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_SETTINGS_H
#define REFOCUS_SETTINGS_H
#include <refocus/params.h>
#include <refocus/render.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_settings {
    struct refocus_render_params render;
    struct refocus_highlight_params highlights;
    struct refocus_thin_params thin;
    struct refocus_look_params look;
    struct refocus_focus_params focus;
    struct refocus_field_params field;
    struct refocus_search_params search;
    struct refocus_jittered_params jittered;
    struct refocus_scatter_params scatter;
    struct refocus_interpolated_params interpolated;
    struct refocus_foveated_params foveated;
    struct refocus_diffusion_params diffusion;
};
static inline struct refocus_settings refocus_settings_default(float focus_disparity,
                                                               float max_blur_radius)
{
    struct refocus_settings settings;
    memset(&settings, 0, sizeof settings);
    settings.render = refocus_render_params_default(focus_disparity, max_blur_radius);
    settings.highlights = refocus_highlight_params_default();
    settings.thin = refocus_thin_params_default();
    settings.look = refocus_look_params_default();
    settings.focus = refocus_focus_params_default();
    settings.field = refocus_field_params_default(focus_disparity);
    settings.search = refocus_search_params_default();
    settings.jittered = refocus_jittered_params_default();
    settings.scatter = refocus_scatter_params_default();
    settings.interpolated = refocus_interpolated_params_default();
    settings.foveated = refocus_foveated_params_default();
    settings.diffusion = refocus_diffusion_params_default();
    return settings;
}
static inline int refocus_render_settings(struct refocus_renderer *renderer,
                                          const struct refocus_settings *settings,
                                          const struct refocus_image *out)
{
    struct refocus_render_params params;
    if (!settings)
        return REFOCUS_ERR_ARGUMENT;
    params = settings->render;
    params.highlights = &settings->highlights;
    params.thin = &settings->thin;
    params.look = &settings->look;
    params.focus = &settings->focus;
    params.field = &settings->field;
    params.search = &settings->search;
    params.jittered = &settings->jittered;
    params.scatter = &settings->scatter;
    params.interpolated = &settings->interpolated;
    params.foveated = &settings->foveated;
    params.diffusion = &settings->diffusion;
    return refocus_render(renderer, &params, out);
}
#ifdef __cplusplus
}
#endif
#endif
