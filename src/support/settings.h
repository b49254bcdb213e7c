/* settings.h: all that a render is asked for, flat, as the core reads it: the public structs of one
 * feature each end in renderer/settings.c. */
#ifndef RF_SETTINGS_H
#define RF_SETTINGS_H

#include <stdint.h>

#include <refocus/params.h>

/* The headers refocus/params.h and refocus/methods.h say what each field means, its unit and its
 * range; the table in renderer/settings.c says which field is which. */
struct rf_settings {
    uint32_t method;
    float focus_disparity, max_blur_radius;
    int32_t rays;
    uint32_t blend;
    float sigma;
    uint32_t prefilter, inpaint, dither;
    int32_t region_x, region_y, region_width, region_height;
    const struct refocus_aperture *aperture;

    float highlight_gain;     /* RF_MOST_GAIN where light is estimated */
    float highlight_estimate; /* times the estimate, or 0 */
    float highlight_steady;   /* part of small changes since the last frame that is left out */
    uint32_t thin;

    float cat_eye, fringe, grain;
    uint32_t grain_seed;
    int32_t star_spikes;
    float star_length, star_angle, star_strength;

    float tilt_x, tilt_y, tilt_across, tilt_down, depth_share;
    float focus_half_width, focus_transition;
    float least_disparity, most_disparity, blur_limit;
    int32_t bands;
    struct refocus_band band[REFOCUS_MAX_BANDS - 1];

    uint32_t field;
    float field_x, field_y, field_disparity, field_radius, field_falloff, field_angle;

    int32_t iterations;
    uint32_t mirror, background;
    int32_t cell;
    uint32_t seed;
    uint32_t spread;
    float airy_radius, depth_ratio;
    float sharp_radius, middle_ratio, last_ratio;
    float attention_x, attention_y, attention_angle, picture_angle, attention_depth;
    int32_t layers;
    uint32_t solver;
    float conductivity;

    /* Maps of the caller, or NULL; they point at the copies below. */
    const struct refocus_disparity *focus_map, *sharp_map, *field_map;
    struct refocus_disparity own_focus_map, own_sharp_map, own_field_map;
};

#endif
