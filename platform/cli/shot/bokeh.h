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

#define BOKEH_NUMBER(type, member, name_, argument_, field_, least_, greatest_, help_)             \
    {                                                                                              \
        OPTION(OPTION_NUMBER, name_, argument_, type, member.field_),                              \
            .least = least_, .greatest = greatest_, .help = help_                                  \
    }

/* Rows of a table of options; `method` is the member with the method. */
#define BOKEH_OPTIONS(type, member, method)                                                        \
    {.kind = OPTION_HEADING, .help = "Bokeh"},                                                     \
        {OPTION(OPTION_CHOICE, "--bokeh", "NAME", type, member.preset),                            \
         .choice = bokeh_preset_name, .summary = bokeh_preset_summary,                             \
         .brief = "the look of a lens", .help = "presets; what else is given overrules them"},     \
        BOKEH_NUMBER(type, member, "--curvature", "C", curvature, 0, 1,                            \
                     "of the blades of a polygon: 0 = straight, the default, 1 = arcs of "         \
                     "the circle"),                                                                \
        {OPTION(OPTION_NUMBER, "--open-f-number", "N", type, member.open_f_number), .least = 0,    \
         .above = true, .greatest = 1000,                                                          \
         .help = "f-number of the lens wide open, where it is round: a polygon shows as "          \
                 "--f-number closes it"},                                                          \
        BOKEH_NUMBER(type, member, "--squeeze", "Q", squeeze, 0.5, 2,                              \
                     "width / height of the discs, below 1 as of an anamorphic lens; default 1"),  \
        BOKEH_NUMBER(type, member, "--ring", "R", ring, 0, 0.9,                                    \
                     "radius of a stop in the middle, as of a mirror lens; default 0"),            \
        BOKEH_NUMBER(type, member, "--edge", "E", edge, -1, 1,                                     \
                     "behind the focus: 1 = bubbles with bright edges, -1 = discs that fade out; " \
                     "before it the contrary; default 0"),                                         \
        BOKEH_NUMBER(type, member, "--edge-before", "E", edge_before, -1, 1,                       \
                     "the edge before the focus, when it is not the contrary"),                    \
        BOKEH_NUMBER(type, member, "--cat-eye", "A", cat_eye, 0, 0.9,                              \
                     "how much narrower discs are in the corners; default 0"),                     \
        BOKEH_NUMBER(type, member, "--fringe", "A", fringe, -0.5, 0.5,                             \
                     "edges of colour: green behind the focus and magenta before it, or "          \
                     "the contrary; default 0"),                                                   \
        {OPTION(OPTION_NUMBER, "--grain", "G", type, member.grain), .least = 0, .greatest = 4,     \
         .word = "off",                                                                            \
         .help = "the photo's noise put back into what is blurred: 1 = as much as was measured, "  \
                 "off = 0; default 1 for stills of 8 bits, 0 for others and for live; --seed "     \
                 "chooses it, in live one more for each frame"},                                   \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--highlight-stops", "S", type, member.highlight_stops),             \
            .least = 0, .greatest = 4,                                                             \
            .help = "sweep, search: light given back to small clipped highlights, in stops, for "  \
                    "--highlights 2^S",                                                            \
            OF_METHODS(type, method, OF_SWEEP | OF_SEARCH)                                         \
    }

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
