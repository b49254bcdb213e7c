/* bokeh.h: the options for the look of the blur: the shape of the aperture and what a lens adds
 * to it. */
#ifndef RF_CLI_BOKEH_H
#define RF_CLI_BOKEH_H

#include <math.h>
#include <refocus/refocus.h>
#include "line/options.h"
#include "shot/methods.h"

struct bokeh_settings {
    int preset;
    /* NAN: not given */
    double curvature, open_f_number, squeeze, ring, edge, edge_before;
    double cat_eye, fringe, grain, highlight_stops;
    double f_number; /* the one of the lens's options, for open_f_number */
};

#define BOKEH_SETTINGS_NONE                                                                        \
    {                                                                                              \
        .curvature = NAN, .open_f_number = NAN, .squeeze = NAN, .ring = NAN, .edge = NAN,          \
        .edge_before = NAN, .cat_eye = NAN, .fringe = NAN, .grain = NAN, .highlight_stops = NAN,   \
        .f_number = NAN                                                                            \
    }

const char *bokeh_preset_name(uint32_t index);
const char *bokeh_preset_summary(uint32_t index);
const char *bokeh_figure_name(uint32_t index);
const char *bokeh_figure_summary(uint32_t index);

/* Refuse what is no shape by name, and might be a picture: an exit code, and reports why, about the
 * option of that name. */
int bokeh_check_is_shape(const char *option, const char *shape);

/* These return exit codes and print why it is not EXIT_DONE. */

/* Make the aperture of --aperture and these. */
int bokeh_aperture(const struct bokeh_settings *settings, const char *shape,
                   struct refocus_aperture **aperture);

/* Whether it is a plain disc. */
bool bokeh_is_plain_disc(const struct bokeh_settings *settings, const char *shape);

/* Rows of all options but the aperture. */
int bokeh_apply(const struct bokeh_settings *settings, bool highlights_given,
                struct refocus_settings *params);

/* Whether the method of params can do what they ask for; the check says so when it
 * cannot. */
bool bokeh_suits_method(const struct refocus_settings *params, bool has_sides);
int bokeh_check_method(const struct refocus_settings *params, bool has_sides);

/* Whether light differs before and behind the focus. */
bool bokeh_has_sides(const struct bokeh_settings *settings);

#endif
