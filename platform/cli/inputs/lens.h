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

/* The options of it. */
extern const struct option focus_options[], lens_options[];

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
 * nothing says where: it is on the subject (inputs/subject.h), else on the centre. */
void input_focus_point(const struct input *input, const struct lens_settings *settings,
                       double at[2]);

/* The disparity of the surface at a pixel: refocus_focus_at_point(). */
double input_surface_at(const uint16_t *disparity, int width, int height, int x, int y);

#endif
