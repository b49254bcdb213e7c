/* papers.h: the options that only single methods look at. */
#ifndef RF_CLI_PAPERS_H
#define RF_CLI_PAPERS_H

#include <math.h>
#include <refocus/refocus.h>
#include "line/options.h"
#include "shot/methods.h"

struct paper_settings {
    double cell, seed; /* NAN: not given */
    double airy_radius, depth_ratio, star, star_length, star_angle, star_strength;
    double sharp_radius, middle_ratio, last_ratio;
    double attention[2], attention_angle, picture_angle, attention_depth;
    double field_at[2], field_disparity, field_radius, field_falloff, field_angle;
    double layers, conductivity;
    int spread, field, solver;
    const char *field_map;
};

#define PAPER_SETTINGS_NONE                                                                        \
    {                                                                                              \
        .cell = NAN, .seed = NAN, .airy_radius = NAN, .depth_ratio = NAN, .star = NAN,             \
        .star_length = NAN, .star_angle = NAN, .star_strength = NAN, .sharp_radius = NAN,          \
        .middle_ratio = NAN, .last_ratio = NAN, .attention = {NAN, NAN}, .attention_angle = NAN,   \
        .picture_angle = NAN, .attention_depth = NAN, .field_at = {NAN, NAN},                      \
        .field_disparity = NAN, .field_radius = NAN, .field_falloff = NAN, .field_angle = NAN,     \
        .layers = NAN, .conductivity = NAN                                                         \
    }

/* Words of --spread, --field and --solver. */
extern const struct option_word papers_spread_words[], papers_field_words[], papers_solver_words[];

#define PAPER_NUMBER(type, member, kind_, name_, argument_, field_, least_, greatest_, help_, ...) \
    {                                                                                              \
        .kind = kind_, .name = name_, .argument = argument_,                                       \
        .offset = offsetof(type, member.field_), .least = least_, .greatest = greatest_,           \
        .count = 2, .help = help_, __VA_ARGS__                                                     \
    }
#define PAPER_CHOICE(type, member, name_, field_, words_, help_, ...)                              \
    {                                                                                              \
        .words = words_, .help = help_, OPTION(OPTION_CHOICE, name_, "NAME", type, member.field_), \
        __VA_ARGS__                                                                                \
    }
#define PAPER_STAR_NEEDS  .needs = "--star,--bokeh"
#define PAPER_FIELD_NEEDS .needs = "--field"

/* Rows of a table of options; `method` is the member with the method. */
#define PAPER_OPTIONS(type, member, method)                                                        \
    {.kind = OPTION_HEADING, .help = "Of single methods"},                                         \
        PAPER_NUMBER(type, member, OPTION_INTEGER, "--cell", "A", cell, 1, 16,                     \
                     "jittered: a ray of each A x A pixels of the mask; default 2",                \
                     OF_METHODS(type, method, OF_JITTERED)),                                       \
        PAPER_NUMBER(type, member, OPTION_INTEGER, "--seed", "N", seed, 0, 999999999,              \
                     "jittered: which ones; of --grain: which; default 0",                         \
                     OF_METHODS(type, method, OF_JITTERED), .needs = "--grain"),                   \
        PAPER_CHOICE(type, member, "--spread", spread, papers_spread_words,                        \
                     "scatter: light in a circle of confusion; default uniform",                   \
                     OF_METHODS(type, method, OF_SCATTER)),                                        \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--airy-radius", "R", airy_radius, 0.25, 16,     \
                     "scatter, lommel: first dark ring of a point in focus, pixels; default 1",    \
                     .needs = "--spread"),                                                         \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--depth-ratio", "Q", depth_ratio, 1, 1000,      \
                     "scatter: far / near metres, for light that falls with the square of the "    \
                     "distance; default 1, not at all",                                            \
                     OF_METHODS(type, method, OF_SCATTER)),                                        \
        PAPER_NUMBER(type, member, OPTION_INTEGER, "--star", "N", star, 0, 16,                     \
                     "sweep, scatter: spikes of a star filter, 0 or 2 to 16; default 0",           \
                     OF_METHODS(type, method, OF_SWEEP | OF_SCATTER)),                             \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--star-length", "L", star_length, 0, 127,       \
                     "pixels of a spike; default 24", PAPER_STAR_NEEDS),                           \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--star-angle", "DEG", star_angle, -3600, 3600,  \
                     "of the first spike, counter-clockwise from the right; default 0",            \
                     PAPER_STAR_NEEDS),                                                            \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--star-strength", "P", star_strength, 0, 1,     \
                     "share of the light in the spikes; default 0.25", PAPER_STAR_NEEDS),          \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--sharp-radius", "R", sharp_radius, 0.5, 16,    \
                     "interpolated: c0, blur radius up to which all is sharp; default 0.5",        \
                     OF_METHODS(type, method, OF_INTERPOLATED)),                                   \
        PAPER_NUMBER(                                                                              \
            type, member, OPTION_NUMBER, "--middle-ratio", "Q", middle_ratio, 1, 1000,             \
            "interpolated: r1, radius of the middle picture / c0, above 1; default (1 + r2) / 2",  \
            OF_METHODS(type, method, OF_INTERPOLATED)),                                            \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--last-ratio", "Q", last_ratio, 1, 1000,        \
                     "interpolated: r2, radius of the last picture / c0, above 1; default: the "   \
                     "largest blur",                                                               \
                     OF_METHODS(type, method, OF_INTERPOLATED)),                                   \
        PAPER_NUMBER(type, member, OPTION_NUMBERS, "--attention", "X,Y", attention, 0, 65535,      \
                     "foveated: pixel that is looked at; default: where the focus is found, as "   \
                     "by --focus-at, else the centre",                                             \
                     OF_METHODS(type, method, OF_FOVEATED)),                                       \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--attention-angle", "DEG", attention_angle, 0,  \
                     170, "foveated: across the exact part; default 10",                           \
                     OF_METHODS(type, method, OF_FOVEATED)),                                       \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--picture-angle", "DEG", picture_angle, 1, 170, \
                     "foveated: across the picture; default 50",                                   \
                     OF_METHODS(type, method, OF_FOVEATED)),                                       \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--attention-depth", "D", attention_depth, 0, 1, \
                     "foveated: disparity about the focus of the exact part; default 1, all",      \
                     OF_METHODS(type, method, OF_FOVEATED)),                                       \
        PAPER_CHOICE(type, member, "--field", field, papers_field_words,                           \
                     "sweep, search, blur, diffusion: where it is blurred; default lens",          \
                     .needs = NULL),                                                               \
        PAPER_NUMBER(type, member, OPTION_NUMBERS, "--field-at", "X,Y", field_at, 0, 65535,        \
                     "pixel of the field's centre; default the picture's", PAPER_FIELD_NEEDS),     \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--field-disparity", "D", field_disparity, 0, 1, \
                     "of the field's centre; default that in focus", PAPER_FIELD_NEEDS),           \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--field-radius", "R", field_radius, 0, 4,       \
                     "distance that stays sharp, of the width or in disparity; default 0.1",       \
                     PAPER_FIELD_NEEDS),                                                           \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--field-falloff", "R", field_falloff, 0.001, 4, \
                     "further distance to the full blur; default 0.3", PAPER_FIELD_NEEDS),         \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--field-angle", "DEG", field_angle, -3600,      \
                     3600, "of a plane: 0 = upright and along the view, 90 = facing it",           \
                     PAPER_FIELD_NEEDS),                                                           \
        {OPTION(OPTION_TEXT, "--field-map", "FILE", type, member.field_map),                       \
         .help = "for picture: grey picture of the field, white = the full blur"},                 \
        PAPER_NUMBER(type, member, OPTION_INTEGER, "--layers", "N", layers, 1, 8,                  \
                     "diffusion: that the picture is split into by depth; default 4",              \
                     OF_METHODS(type, method, OF_DIFFUSION)),                                      \
        PAPER_CHOICE(type, member, "--solver", solver, papers_solver_words,                        \
                     "diffusion: series (default), or the paper's single steps",                   \
                     OF_METHODS(type, method, OF_DIFFUSION)),                                      \
        PAPER_NUMBER(type, member, OPTION_NUMBER, "--conductivity", "W", conductivity, 0.01, 1,    \
                     "diffusion: weight of a step where blur is strongest; default 0.125",         \
                     OF_METHODS(type, method, OF_DIFFUSION))

/* Into params, for a photo of this size. Returns an exit code and prints why it is not
 * EXIT_DONE; *map, of *field_map, is to be freed by the caller. */
int papers_apply(const struct paper_settings *settings, struct refocus_settings *params,
                 struct refocus_disparity *map);

/* The parts that need the photo's size. */
int papers_place(const struct paper_settings *settings, struct refocus_settings *params, int width,
                 int height);

/* Set what single methods take of a photo where no option says it: `foveated` the pixel where the
 * focus is. NAN: not known. */
void papers_suit(const struct paper_settings *settings, const double looked_at[2], int width,
                 int height, struct refocus_settings *params);

/* A grey picture from a file, one byte a pixel and no padding, to be freed. */
uint8_t *papers_read_grey(const char *file, int *width, int *height);

#endif
