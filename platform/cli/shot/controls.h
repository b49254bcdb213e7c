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

#define CONTROL_NUMBER(type, member, name_, argument_, field_, least_, greatest_, help_)           \
    {                                                                                              \
        OPTION(OPTION_NUMBER, name_, argument_, type, member.field_),                              \
            .least = least_, .greatest = greatest_, .help = help_                                  \
    }
#define CONTROL_NUMBERS(type, member, name_, argument_, field_, count_, help_)                     \
    {                                                                                              \
        OPTION(OPTION_NUMBERS, name_, argument_, type, member.field_),                             \
            .least = 0, .greatest = REFOCUS_MAX_SIDE - 1, .count = count_, .help = help_           \
    }
#define CONTROL_TEXT(type, member, name_, argument_, field_, help_)                                \
    {                                                                                              \
        OPTION(OPTION_TEXT, name_, argument_, type, member.field_), .help = help_                  \
    }

/* Rows of a table of options. */
#define FOCUS_CONTROL_OPTIONS(type, member)                                                        \
    {.kind = OPTION_HEADING, .help = "Focus beyond a plain lens"},                                 \
        CONTROL_NUMBER(type, member, "--focus-width", "W", focus_width, 0, 1,                      \
                       "disparities to either side of the focus that stay sharp; default 0"),      \
        CONTROL_NUMBER(type, member, "--focus-transition", "W", focus_transition, 0, 1,            \
                       "further disparities over which the blur grows to the lens's; default "     \
                       "that of --focus-width"),                                                   \
        CONTROL_TEXT(type, member, "--also-focus", "D:W:T,...", also_focus,                        \
                     "up to 15 more bands in focus: a disparity and, if wanted, its width and "    \
                     "transition; default those of the focus"),                                    \
        CONTROL_NUMBERS(type, member, "--focus-plane", "X,Y,X,Y,X,Y", focus_plane, 6,              \
                        "plane of focus through what is seen at three pixels, as of a view "       \
                        "camera; in place of --focus..."),                                         \
        CONTROL_NUMBERS(type, member, "--tilt-line", "X,Y,X,Y", tilt_line, 4,                      \
                        "line of the photo that the plane of focus passes at the focus, for "      \
                        "--tilt-angle; default: level, through --focus-at or the centre"),         \
        CONTROL_NUMBER(type, member, "--tilt-angle", "DEG", tilt_angle, -89, 89,                   \
                       "angle of the plane of focus: at 45 the disparity in focus grows by 1 "     \
                       "over a picture's width, to the right of the line; default 0"),             \
        CONTROL_NUMBER(type, member, "--tilt-compress", "C", tilt_compress, 0, 1,                  \
                       "how much depth is compressed along that line: 0 = not, the default, 1 = "  \
                       "only the place counts, as in pictures of miniatures"),                     \
        CONTROL_TEXT(type, member, "--focus-map", "FILE", focus_map,                               \
                     "surface in focus: grey picture of the disparity in focus at each place"),    \
        CONTROL_TEXT(type, member, "--sharp-mask", "FILE", sharp_mask,                             \
                     "what stays sharp whatever its depth: grey picture, white = sharp"),          \
        CONTROL_NUMBER(type, member, "--far-clamp", "D", far_clamp, 0, 1,                          \
                       "disparity beyond which nothing is blurred more; default 0"),               \
        CONTROL_NUMBER(type, member, "--near-clamp", "D", near_clamp, 0, 1,                        \
                       "disparity before which nothing is blurred more; default 1"),               \
        CONTROL_NUMBER(type, member, "--blur-limit", "R", blur_limit, 0, REFOCUS_MAX_BLUR_RADIUS,  \
                       "largest blur radius, pixels; default 944")
#define CONTROL_OPTIONS(type, member) FOCUS_CONTROL_OPTIONS(type, member)

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
