/* inputs.h: a photo and its disparities, as the options ask for them. */
#ifndef RF_CLI_INPUTS_H
#define RF_CLI_INPUTS_H

#include <math.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "inputs/edges.h"
#include "inputs/limits.h"
#include "inputs/orient.h"
#include "inputs/upsample.h"
#include "inputs/ways.h"
#include "line/option.h"

/* Photos of more than 8 bits that are rendered from all that they hold: none, those with light
 * above white, or all. */
enum deep { DEEP_NONE, DEEP_LIGHT, DEEP_ALL };

/* A photo's gain map makes its light, or is ignored. */
enum gain_map { GAIN_MAP_USE, GAIN_MAP_IGNORE };
const char *gain_map_name(uint32_t index);
const char *gain_map_summary(uint32_t index);

struct input;

struct depth_settings {
    const char *file, *unit, *matte;
    double near_m, far_m; /* NAN: not given */
    double speckle;       /* patches of fewer samples are removed; 0: none */
    const char *invalid;  /* names of the codes that mean "no value", or NULL */
    bool full;            /* bring the depth to the photo's size */
    bool optional;        /* a photo without any will do: its disparities are NULL
                             then */
    int deep;             /* enum deep */
    int transfer;         /* enum refocus_transfer by which deep photos are read; 0: as files do */
    bool light;           /* light by a gain map can be rendered */
    int gain_map;         /* enum gain_map */
    bool no_dither;       /* light becomes 8 bits by rounding */
    double white;         /* light of them that is white; NAN: 1, or the transfer's own */
    int edges;            /* enum edges */
    int orient;           /* enum orient */
    int upsample;         /* the filter that brings maps of another size to the photo's: an index
                             of upsample_name() */
    struct limit_settings limits;
    const char *model, *right; /* depth is made by a network, or of this and the photo; or NULL */
    struct network_settings network;
    struct stereo_settings stereo;
    /* Makes the depth of a photo that was read, where it is not read itself; or NULL. An exit code,
     * and prints why. */
    int (*make)(struct input *input, const struct depth_settings *settings);
};

#define DEPTH_SETTINGS_NONE                                                                        \
    {                                                                                              \
        .near_m = NAN, .far_m = NAN, .white = NAN, .limits = LIMIT_SETTINGS_NONE,                  \
        .network = NETWORK_SETTINGS_NONE                                                           \
    }
/* Rows for tables of options, where the settings have a member of the type above. */
#define DEPTH_FILE_OPTION(type, member)                                                            \
    {                                                                                              \
        .kind = OPTION_TEXT, .name = "--depth", .argument = "FILE",                                \
        .offset = offsetof(type, member.file),                                                     \
        .brief = "depth map; without it the one that the photo carries",                           \
        .help = "depth map: PNG, PGM or JPEG of 8 or 16 bits, PFM, or a photo that "               \
                "carries one; without it the depth that the photo itself carries"                  \
    }
#define DEPTH_RANGE_OPTIONS(type, member)                                                          \
    {.kind = OPTION_NUMBER,                                                                        \
     .name = "--near",                                                                             \
     .argument = "M",                                                                              \
     .offset = offsetof(type, member.near_m),                                                      \
     .least = 0,                                                                                   \
     .above = true,                                                                                \
     .greatest = 1e9,                                                                              \
     .help = "metres of disparity 1; default: what the file says, else what is "                   \
             "measured in distances"},                                                             \
    {                                                                                              \
        .kind = OPTION_NUMBER, .name = "--far", .argument = "M",                                   \
        .offset = offsetof(type, member.far_m), .least = 0, .above = true, .greatest = INFINITY,   \
        .help = "metres of disparity 0, also 'inf'; default as for --near"                         \
    }
#define DEPTH_UNIT_OPTIONS(type, member)                                                           \
    {.kind = OPTION_TEXT,                                                                          \
     .name = "--depth-unit",                                                                       \
     .argument = "U",                                                                              \
     .offset = offsetof(type, member.unit),                                                        \
     .brief = "disparity (bright = near), inverse, mm, m, or 5000/m",                              \
     .help = "what its samples are: disparity (bright = near), inverse (dark = "                   \
             "near), mm, m, or a number per metre such as 5000/m; default: what the "              \
             "file says, else disparity"},                                                         \
        DEPTH_RANGE_OPTIONS(type, member)
#define DEPTH_WAYS_OPTIONS(type, member)                                                           \
    ESTIMATE_OPTIONS(type, member.model, member.network, NULL),                                    \
        {.kind = OPTION_TEXT,                                                                      \
         .name = "--stereo",                                                                       \
         .argument = "RIGHT",                                                                      \
         .offset = offsetof(type, member.right),                                                   \
         .help = "depth of the photo and the right picture of its stereo pair"},                   \
        STEREO_FILE_OPTION(type, member.stereo, NULL),                                             \
    {                                                                                              \
        MATCH_OPTION(type, member.stereo, NULL), .needs = "--stereo,--stereo-file"                 \
    }
#define DEPTH_EDGES_OPTION(type, member)                                                           \
    {                                                                                              \
        .kind = OPTION_CHOICE, .name = "--depth-edges", .argument = "HOW",                         \
        .offset = offsetof(type, member.edges), .choice = edges_name, .summary = edges_summary,    \
        .help = "the edges of the depth map"                                                       \
    }
#define ORIENT_DEPTH_OPTION(type, member)                                                          \
    {                                                                                              \
        .kind = OPTION_CHOICE, .name = "--orient-depth", .argument = "DEGREES",                    \
        .offset = offsetof(type, member.orient), .choice = orient_name, .summary = orient_summary, \
        .help = "turn the depth map clockwise; default auto"                                       \
    }
#define UPSAMPLE_OPTION(type, member)                                                              \
    {                                                                                              \
        .kind = OPTION_CHOICE, .name = "--upsample", .argument = "HOW",                            \
        .offset = offsetof(type, member.upsample), .choice = upsample_name,                        \
        .help = "how a map of another size gets the photo's, before --depth-edges: by the "        \
                "library (default), or by filters of OpenCV, the last three by its module "        \
                "refocus-ximgproc"                                                                 \
    }
#define LIGHT_OPTIONS(type, member)                                                                \
    {.kind = OPTION_CHOICE,                                                                        \
     .name = "--gain-map",                                                                         \
     .argument = "HOW",                                                                            \
     .offset = offsetof(type, member.gain_map),                                                    \
     .choice = gain_map_name,                                                                      \
     .summary = gain_map_summary,                                                                  \
     .help = "the gain map of a photo (Ultra HDR, ISO 21496-1, Apple); default use"},              \
    {                                                                                              \
        .kind = OPTION_FLAG, .name = "--no-dither", .offset = offsetof(type, member.no_dither),    \
        .help = "photos of more than 8 bits, or with a gain map: 8 bits of the result are rounded" \
    }
#define MATTE_OPTION(type, member)                                                                 \
    {                                                                                              \
        .kind = OPTION_TEXT, .name = "--matte", .argument = "FILE|none",                           \
        .offset = offsetof(type, member.matte),                                                    \
        .help = "how much of each pixel is subject: a grey PNG, PGM or JPEG of 8 or 16 bits, "     \
                "white = subject; its edges and hair are drawn by it (sweep); default: the "       \
                "portrait matte "                                                                  \
                "of the photo, if it has one; none: no matte"                                      \
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
    struct refocus_image deep;              /* all that the photo holds; plane[0] NULL: 8 bits */
    struct refocus_light *light;            /* light by a gain map, in `deep`; NULL: none */
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
    int orientation;                /* EXIF's, by which the map is turned; 0 and 1: not */
    int width, height;              /* size of the disparities: the map's, or the photo's */
    double most_blur;               /* pixels that may be rendered; 0: all that the library can */
    struct refocus_depth_report report;
    struct refocus_depth_edges_report edges; /* by depth --full; struct_size 0: as given */
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Whether depth is to be made of pictures by `model`, `right` or `stereo`. */
bool input_depth_is_made(const struct depth_settings *settings);

/* Called before anything is read. */
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
/* Put --near, --far and --depth-unit over what the photo says about its own depth. */
int input_settle_embedded(struct input *input, const struct depth_settings *settings);

/* Whether edges of the disparities go to the photo's: where there is a photo, unless the settings
 * say otherwise. */
bool input_has_edges_placed(const struct input *input, const struct depth_settings *settings);

/* Make the disparities from input->depth_from: repaired and enlarged as the settings say. */
int input_convert(struct input *input, const struct depth_settings *settings);
/* The disparities as depth_settings.full makes them, packed, of the photo's size, to be freed; the
 * input stays as it is. */
int input_placed(const struct input *input, const struct depth_settings *settings,
                 uint16_t **placed);
void input_free(struct input *input);

/* null, or the matte's file, size, and the parts of it that are subject, and mixed. */
json_t *input_matte_json(const struct input *input);

/* How sure each disparity is, 255 to 0, where the renderer is to enlarge the map by that; else
 * NULL. */
const uint8_t *input_confidence(const struct input *input);

/* The photo and a map of its depth, with the matte if there is one, which all stay the caller's. */
struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map);

/* The exit code for a status of the file library. */
int input_exit_code(int status);

#endif
