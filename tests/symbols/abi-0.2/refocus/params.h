/* params.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_PARAMS_H
#define REFOCUS_PARAMS_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/aperture.h>
#include <refocus/image.h>
#include <refocus/methods.h>
#include <refocus/sized.h>
#ifdef __cplusplus
extern "C" {
#endif
enum { REFOCUS_MAX_BLUR_RADIUS = 127 };
enum refocus_blend {
    REFOCUS_BLEND_LINEAR = 0,
    REFOCUS_BLEND_STORED = 1,
    REFOCUS_BLEND_GAMMA = 2,
};
enum { REFOCUS_RAYS_FULL = -1 };
struct refocus_highlight_params {
    uint32_t struct_size;
    float gain;
};
static inline struct refocus_highlight_params refocus_highlight_params_default(void)
{
    struct refocus_highlight_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.gain = 1;
    return params;
}
struct refocus_thin_params {
    uint32_t struct_size;
    uint32_t enabled;
};
static inline struct refocus_thin_params refocus_thin_params_default(void)
{
    struct refocus_thin_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}
struct refocus_look_params {
    uint32_t struct_size;
    float cat_eye;
    float fringe;
    float grain;
    uint32_t grain_seed;
    int32_t star_spikes;
    float star_length;
    float star_angle;
    float star_strength;
};
static inline struct refocus_look_params refocus_look_params_default(void)
{
    struct refocus_look_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.star_length = 24;
    params.star_strength = (float)0.25;
    return params;
}
enum { REFOCUS_MAX_BANDS = 16, REFOCUS_MAX_TILT = 64 };
struct refocus_band {
    float disparity;
    float half_width;
    float transition;
};
struct refocus_focus_params {
    uint32_t struct_size;
    float tilt_x, tilt_y;
    float tilt_across, tilt_down;
    float depth_share;
    float half_width;
    float transition;
    float least_disparity;
    float most_disparity;
    float blur_limit;
    int32_t bands;
    const struct refocus_disparity *map;
    const struct refocus_disparity *sharp_map;
    struct refocus_band band[REFOCUS_MAX_BANDS - 1];
    uint32_t reserved;
};
static inline struct refocus_focus_params refocus_focus_params_default(void)
{
    struct refocus_focus_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.tilt_x = params.tilt_y = (float)0.5;
    params.depth_share = params.most_disparity = 1;
    params.blur_limit = REFOCUS_MAX_BLUR_RADIUS;
    return params;
}
enum refocus_field {
    REFOCUS_FIELD_LENS = 0,
    REFOCUS_FIELD_CYLINDER = 1,
    REFOCUS_FIELD_PLUS = 2,
    REFOCUS_FIELD_PLANE = 3,
    REFOCUS_FIELD_SPHERE = 4,
    REFOCUS_FIELD_PICTURE = 5,
};
struct refocus_field_params {
    uint32_t struct_size;
    uint32_t shape;
    float x, y;
    float disparity;
    float radius;
    float falloff;
    float angle;
    const struct refocus_disparity *map;
};
static inline struct refocus_field_params refocus_field_params_default(float disparity)
{
    struct refocus_field_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.x = params.y = (float)0.5;
    params.disparity = disparity;
    params.radius = (float)0.1;
    params.falloff = (float)0.3;
    return params;
}
struct refocus_render_params {
    uint32_t struct_size;
    uint32_t method;
    float focus_disparity;
    float max_blur_radius;
    int32_t rays;
    uint32_t blend;
    float sigma;
    uint32_t prefilter;
    int32_t region_x, region_y;
    int32_t region_width, region_height;
    const struct refocus_aperture *aperture;
    const struct refocus_highlight_params *highlights;
    const struct refocus_thin_params *thin;
    const struct refocus_look_params *look;
    const struct refocus_focus_params *focus;
    const struct refocus_field_params *field;
    const struct refocus_search_params *search;
    const struct refocus_jittered_params *jittered;
    const struct refocus_scatter_params *scatter;
    const struct refocus_interpolated_params *interpolated;
    const struct refocus_foveated_params *foveated;
    const struct refocus_diffusion_params *diffusion;
};
static inline struct refocus_render_params refocus_render_params_default(float focus_disparity,
                                                                         float max_blur_radius)
{
    struct refocus_render_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.focus_disparity = focus_disparity;
    params.max_blur_radius = max_blur_radius;
    params.rays = 64;
    params.sigma = (float)1e30;
    params.prefilter = 1;
    return params;
}
#ifdef __cplusplus
}
#endif
#endif
