/* lens.h: focus and blur, as the options and the photo say them. */
#ifndef RF_CLI_LENS_H
#define RF_CLI_LENS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include "inputs/read_input.h"
#include "line/option.h"

struct lens_settings {
    double focus, focus_at[2], focus_distance, focus_rectangle[4];
    double blur, f_number, focal_length, sensor_width;
};

#define LENS_SETTINGS_NONE                                                                         \
    {                                                                                              \
        .focus = NAN, .focus_at = {NAN, NAN}, .focus_distance = NAN, .focus_rectangle = {NAN},     \
        .blur = NAN, .f_number = NAN, .focal_length = NAN, .sensor_width = NAN                     \
    }

/* Rows for tables of options, where the settings have a member of the type above. */
#define FOCUS_OPTIONS(type, member)                                                                \
    {OPTION(OPTION_NUMBER, "--focus", "D", type, member.focus),                                    \
     .group = "focus",                                                                             \
     .least = 0,                                                                                   \
     .greatest = 1,                                                                                \
     .brief = "disparity in focus: 1 nearest, 0 farthest",                                         \
     .help = "disparity in focus: 1 nearest, 0 farthest"},                                         \
        {OPTION(OPTION_NUMBERS, "--focus-at", "X,Y", type, member.focus_at),                       \
         .group = "focus",                                                                         \
         .least = -INFINITY,                                                                       \
         .greatest = INFINITY,                                                                     \
         .count = 2,                                                                               \
         .brief = "focus on the surface at that pixel",                                            \
         .help = "focus on the surface at that pixel: the nearer one at an edge; without "         \
                 "any --focus...: the point or distance that the file names, else the centre"},    \
        {OPTION(OPTION_NUMBERS, "--focus-rectangle", "X,Y,W,H", type, member.focus_rectangle),     \
         .group = "focus",                                                                         \
         .least = 0,                                                                               \
         .greatest = REFOCUS_MAX_SIDE,                                                             \
         .count = 4,                                                                               \
         .help = "focus on the nearest surface that has a quarter of that rectangle, pixels"},     \
        {OPTION(OPTION_NUMBER, "--focus-distance", "M", type, member.focus_distance),              \
         .group = "focus",                                                                         \
         .least = 0,                                                                               \
         .above = true,                                                                            \
         .greatest = INFINITY,                                                                     \
         .help = "metres in focus, also 'inf'; near and far must be known"},                       \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--blur", "K", type, member.blur),                                   \
            .group = "blur", .least = 0, .greatest = REFOCUS_MAX_BLUR_RADIUS,                      \
            .brief = "largest blur radius, pixels",                                                \
            .help = "blur radius in pixels of disparity 0 when 1 is in focus; without it "         \
                    "and --f-number: the blur that the file names, or of the lens that its "       \
                    "phone simulates, else 1/50 of the larger side, at most 127"                   \
    }
#define LENS_OPTIONS(type, member)                                                                 \
    {OPTION(OPTION_NUMBER, "--f-number", "N", type, member.f_number),                              \
     .group = "blur",                                                                              \
     .least = 0,                                                                                   \
     .above = true,                                                                                \
     .greatest = 1000,                                                                             \
     .brief = "the blur of such a lens instead",                                                   \
     .help = "blur of a lens of this f-number, at most 944 pixels; without a focal length, or "    \
             "metres of the depth, the blur that the file names, or the default, which stands "    \
             "for the f-number of the file, or f/2, made more or less"},                           \
        {OPTION(OPTION_NUMBER, "--focal-length", "MM", type, member.focal_length), .least = 0,     \
         .above = true, .greatest = 100000,                                                        \
         .help = "focal length for --f-number; default: the EXIF focal length in 35 mm terms, "    \
                 "for the blur that a full-frame camera has at that f-number"},                    \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--sensor-width", "MM", type, member.sensor_width),                  \
            .least = 0, .above = true, .greatest = 10000,                                          \
            .help = "width of the sensor area that the picture shows, with --focal-length; "       \
                    "default: 36 mm for the larger side of the picture"                            \
    }

/* These return exit codes and print why it is not EXIT_DONE, unless they say otherwise. */

int input_check_lens(const struct lens_settings *settings);

/* The lens of --f-number and --focal-length, for pictures of this size. */
struct refocus_lens input_given_lens(const struct lens_settings *settings, int width, int height);

/* The lens of --f-number; see the help of LENS_OPTIONS for what stands in for what. Returns false
 * where no focal length is known: then it has none. */
bool input_lens(const struct input *input, const struct lens_settings *settings,
                struct refocus_lens *lens);

/* Whether the settings say what is in focus. */
bool input_focus_is_given(const struct lens_settings *settings);

/* K by the settings; a warning says when --f-number could not be taken at its word. */
int input_blur(const struct input *input, const struct lens_settings *settings, double *blur);

/* K without a warning, and the f-number that has that blur; NAN: none was given. */
int input_blur_and_f_number(const struct input *input, const struct lens_settings *settings,
                            double *blur, double *f_number);

/* K without any option, and where it is from, in words. */
enum { INPUT_WHY = 80 };
void input_default_blur(const struct input *input, double *blur, char why[INPUT_WHY]);

/* How input_blur() came by K, for reports: "blur_from", and the "f_number" that has that blur. */
json_t *input_blur_json(const struct input *input, const struct lens_settings *settings);

/* df by the settings; prepared: the packed disparities of the photo's size. */
int input_focus(const struct input *input, const struct lens_settings *settings,
                const uint16_t *prepared, double *focus);

/* The pixel where the focus is found, by the settings or the file; NAN: it is not found at one, or
 * at the centre because nothing says where. */
void input_focus_point(const struct input *input, const struct lens_settings *settings,
                       double at[2]);

/* The disparity of the surface at a pixel: refocus_focus_at_point(). */
double input_surface_at(const uint16_t *disparity, int width, int height, int x, int y);

#endif
