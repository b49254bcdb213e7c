/* inputs.h: a photo and its disparities, as the options ask for them. */
#ifndef RF_CLI_INPUTS_H
#define RF_CLI_INPUTS_H

#include <math.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "inputs/edges.h"
#include "line/option.h"

struct depth_settings {
    const char *file, *unit, *matte;
    double near_m, far_m; /* NAN: not given */
    double speckle;       /* patches of fewer samples are removed; 0: none */
    const char *invalid;  /* names of the codes that mean "no value", or NULL */
    bool full;            /* bring the depth to the photo's size */
    bool optional;        /* a photo without any will do: its disparities are NULL
                             then */
    int edges;            /* enum edges */
    int upsample;         /* how; 0: as the core does, else 1 + enum
                             refocus_cv_filter */
};

#define DEPTH_SETTINGS_NONE                                                                        \
    {                                                                                              \
        .near_m = NAN, .far_m = NAN                                                                \
    }
/* Rows for tables of options, where the settings have a member of the type above. */
#define DEPTH_FILE_OPTION(type, member)                                                            \
    {                                                                                              \
        .kind = OPTION_TEXT, .name = "--depth", .argument = "FILE",                                \
        .offset = offsetof(type, member.file),                                                     \
        .help = "depth map: PNG, PGM or JPEG of 8 or 16 bits, PFM, or a photo that "               \
                "carries one; without it the depth that the photo itself carries"                  \
    }
#define DEPTH_UNIT_OPTIONS(type, member)                                                           \
    {.kind = OPTION_TEXT,                                                                          \
     .name = "--depth-unit",                                                                       \
     .argument = "U",                                                                              \
     .offset = offsetof(type, member.unit),                                                        \
     .help = "what its samples are: disparity (bright = near), inverse (dark = "                   \
             "near), mm, m, or a number per metre such as 5000/m; default: what the "              \
             "file says, else disparity"},                                                         \
        {.kind = OPTION_NUMBER,                                                                    \
         .name = "--near",                                                                         \
         .argument = "M",                                                                          \
         .offset = offsetof(type, member.near_m),                                                  \
         .least = 0,                                                                               \
         .above = true,                                                                            \
         .greatest = 1e9,                                                                          \
         .help = "metres of disparity 1; default: what the file says, else what is "               \
                 "measured in distances"},                                                         \
    {                                                                                              \
        .kind = OPTION_NUMBER, .name = "--far", .argument = "M",                                   \
        .offset = offsetof(type, member.far_m), .least = 0, .above = true, .greatest = INFINITY,   \
        .help = "metres of disparity 0, also 'inf'; default as for --near"                         \
    }
#define DEPTH_EDGES_OPTION(type, member)                                                           \
    {                                                                                              \
        .kind = OPTION_CHOICE, .name = "--depth-edges", .argument = "HOW",                         \
        .offset = offsetof(type, member.edges), .choice = edges_name, .summary = edges_summary,    \
        .help = "the edges of the depth map"                                                       \
    }
#define MATTE_OPTION(type, member)                                                                 \
    {                                                                                              \
        .kind = OPTION_TEXT, .name = "--matte", .argument = "FILE",                                \
        .offset = offsetof(type, member.matte),                                                    \
        .help = "how much of each pixel is subject: a grey PNG, PGM or JPEG of 8 or 16 bits, "     \
                "white = subject; its edges and hair are drawn by it (sweep)"                      \
    }
#define REPAIR_OPTIONS(type, member)                                                               \
    {.kind = OPTION_TEXT,                                                                          \
     .name = "--invalid",                                                                          \
     .argument = "CODES",                                                                          \
     .offset = offsetof(type, member.invalid),                                                     \
     .help = "samples that hold no value, with commas: zero, max (255 or 65535), "                 \
             "2047; NaN and infinity never do, nor does zero in distances"},                       \
    {                                                                                              \
        .kind = OPTION_INTEGER, .name = "--speckle", .argument = "N",                              \
        .offset = offsetof(type, member.speckle), .least = 0, .greatest = REFOCUS_MAX_SPECKLE,     \
        .help = "fill patches of fewer than N samples like holes; default 0: none"                 \
    }
struct input {
    const char *photo_name, *depth_name;
    struct refocus_photo *photo;
    struct refocus_photo *side;             /* a depth file of its own, or NULL */
    const struct refocus_photo *depth_from; /* one of the two, or `made` */
    struct refocus_photo made;              /* depth made of pictures; its parts follow */
    struct refocus_depth_map made_map;
    struct refocus_photo_info made_info;
    float *made_samples;
    uint16_t *disparity; /* packed */
    uint8_t *confidence; /* one for each sample of the map: 0 = filled */
    const char *matte_name;
    uint16_t *matte_samples;        /* packed, or NULL */
    struct refocus_disparity matte; /* samples NULL: none */
    int width, height;              /* size of the disparities: the map's, or the photo's */
    struct refocus_depth_report report;
    struct refocus_depth_edges_report edges; /* by depth --full; struct_size 0: as given */
};

/* These return exit codes and print why it is not EXIT_DONE. */
int input_check_depth(const struct depth_settings *settings);

/* Read a photo into a new input, which it names; ended by input_free(), also after an
 * error. What to give instead of a depth map ends the words of that error. */
int input_read_photo(struct input *input, const char *photo, const char *instead);

/* Print one line where a photo has more than the 8 bits a channel that are rendered. */
void input_tell_bits(const struct refocus_photo *photo, const char *name);

/* Read a photo and its depth; ended by input_free(), also after an error. */
int input_read(struct input *input, const char *photo, const struct depth_settings *settings);

/* Read a depth file, or the depth of a photo; input->photo is NULL afterwards. */
int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings);
/* Whether edges of the disparities go to the photo's: where there is a photo, unless the settings
 * say otherwise. */
bool input_has_edges_placed(const struct input *input, const struct depth_settings *settings);

/* Make the disparities from input->depth_from: repaired and enlarged as the settings say. */
int input_convert(struct input *input, const struct depth_settings *settings);
void input_free(struct input *input);

/* null, or the matte's file, size, and the parts of it that are subject, and mixed. */
json_t *input_matte_json(const struct input *input);

/* The photo and a map of its depth, with the matte if there is one, which all stay the caller's. */
struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map);

/* The exit code for a status of the file library. */
int input_exit_code(int status);

#endif
