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
