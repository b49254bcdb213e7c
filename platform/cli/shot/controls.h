/* controls.h: the options for focus beyond a plain lens. */
#ifndef RF_CLI_CONTROLS_H
#define RF_CLI_CONTROLS_H

#include <math.h>
#include <refocus/refocus.h>
#include "line/options.h"

struct control_settings {
    double focus_width, focus_transition; /* NAN: not given, here and below */
    const char *also_focus;
    double focus_plane[6], tilt_line[4], tilt_angle, tilt_compress;
    const char *focus_map, *sharp_mask;
    double far_clamp, near_clamp, blur_limit;
};

#define CONTROL_SETTINGS_NONE                                                                      \
    {                                                                                              \
        .focus_width = NAN, .focus_transition = NAN, .focus_plane = {NAN}, .tilt_line = {NAN},     \
        .tilt_angle = NAN, .tilt_compress = NAN, .far_clamp = NAN, .near_clamp = NAN,              \
        .blur_limit = NAN                                                                          \
    }

/* Maps that options name, and what is settled when the photo is there. */
struct controls {
    struct refocus_disparity focus_map, sharp_mask; /* samples NULL: none */
    double focus_plane[6], tilt_line[4], tilt_angle;
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Called before a photo is read: the options go into params and controls, whose memory is freed by
 * controls_free(), also after an error. */
int controls_apply(const struct control_settings *settings, struct refocus_settings *params,
                   struct controls *controls);

/* Whether the plane of focus is given and a focus too. */
int controls_check(const struct control_settings *settings, bool focus_given);

/* Let the plane of --tilt-angle turn about the level line through a pixel, unless
 * --tilt-line says about which. */
void controls_turn_about(struct controls *controls, const struct refocus_image *photo, double y);

/* The parts that need the prepared photo and params->render.focus_disparity. */
int controls_aim(const struct controls *controls, struct refocus_settings *params,
                 const struct refocus_disparity *prepared);

/* Whether the method of params can do what they ask for; the check says so when it
 * cannot. */
bool controls_suit_method(const struct refocus_settings *params);
int controls_check_method(const struct refocus_settings *params);

void controls_free(struct controls *controls);

#endif
