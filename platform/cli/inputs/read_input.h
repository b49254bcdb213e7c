/* read_input.h: reads a photo and its disparities as the options ask for them. */
#ifndef RF_CLI_READ_INPUT_H
#define RF_CLI_READ_INPUT_H

#include "inputs/disparities.h"
#include "inputs/input.h"
#include "line/option.h"

/* Words of --gain-map. */
extern const struct option_word gain_map_words[];

/* Rows for tables of options, where the settings have a member of struct depth_settings. */
#define DEPTH_FILE_OPTION(type, member)                                                            \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--depth", "FILE", type, member.file),                                 \
            .brief = "depth map; without it the one that the photo carries",                       \
            .help = "depth map: PNG, PGM or JPEG of 8 or 16 bits, PFM, NumPy's .npy or .npz, or "  \
                    "a photo that carries one; without it the depth that the photo itself carries" \
    }
#define DEPTH_RANGE_OPTIONS(type, member)                                                          \
    {OPTION(OPTION_NUMBER, "--near", "M", type, member.near_m), .least = 0, .above = true,         \
     .greatest = 1e9,                                                                              \
     .help = "metres of disparity 1; default: what the file says, else what is "                   \
             "measured in distances, without single samples far nearer than all others"},          \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--far", "M", type, member.far_m),                                   \
            .least = 0, .above = true, .greatest = INFINITY,                                       \
            .help = "metres of disparity 0, also 'inf'; default as for --near"                     \
    }
#define DEPTH_UNIT_OPTIONS(type, member)                                                           \
    {OPTION(OPTION_TEXT, "--depth-unit", "U", type, member.unit),                                  \
     .brief = "disparity (bright = near), inverse, mm, m, or 5000/m",                              \
     .help = "what its samples are: disparity (bright = near), inverse (dark = near), "            \
             "disparity/16 (16ths of a pixel, range measured), mm, m, or a number per metre "      \
             "such as 5000/m; default: what the file says, else disparity"},                       \
        DEPTH_RANGE_OPTIONS(type, member)
#define DEPTH_WAYS_OPTIONS(type, member)                                                           \
    ESTIMATE_OPTIONS(type, member.model, member.network, NULL),                                    \
        {OPTION(OPTION_TEXT, "--stereo", "RIGHT", type, member.right),                             \
         .help = "depth of the photo and the right picture of its stereo pair"},                   \
        STEREO_FILE_OPTION(type, member.stereo, NULL),                                             \
        {MATCH_OPTION(type, member.stereo, NULL), .needs = "--stereo,--stereo-file"},              \
    {                                                                                              \
        PAIR_ORDER_OPTION(type, member.stereo), .needs = "--stereo,--stereo-file"                  \
    }
#define DEPTH_EDGES_OPTION(type, member)                                                           \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--depth-edges", "HOW", type, member.edges),                         \
            .words = edges_words, .help = "the edges of the depth map"                             \
    }
#define ORIENT_DEPTH_OPTION(type, member)                                                          \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--orient-depth", "DEGREES", type, member.orient),                   \
            .words = orient_words, .help = "turn the depth map clockwise; default auto"            \
    }
#define UPSAMPLE_OPTION(type, member)                                                              \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--upsample", "HOW", type, member.upsample),                         \
            .words = upsample_words,                                                               \
            .help = "how a map of another size gets the photo's, before --depth-edges: by the "    \
                    "library (default), or by filters of OpenCV, the last three by its module "    \
                    "refocus-ximgproc"                                                             \
    }
#define LIGHT_OPTIONS(type, member)                                                                \
    {OPTION(OPTION_CHOICE, "--gain-map", "HOW", type, member.gain_map), .words = gain_map_words,   \
     .help = "the gain map of a photo (Ultra HDR, ISO 21496-1, Apple); default use"},              \
    {                                                                                              \
        OPTION(OPTION_FLAG, "--no-dither", NULL, type, member.no_dither),                          \
            .help =                                                                                \
                "photos of more than 8 bits, or with a gain map: 8 bits of the result are rounded" \
    }
#define MATTE_OPTION(type, member)                                                                 \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--matte", "FILE|none", type, member.matte),                           \
            .help = "how much of each pixel is subject: a grey PNG, PGM or JPEG of 8 or 16 bits, " \
                    "white = subject; its edges and hair are drawn by it (sweep); default: the "   \
                    "portrait matte of the photo, if it has one; none: no matte"                   \
    }
#define INVALID_OPTION(type, member)                                                               \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--invalid", "CODES", type, member.invalid),                           \
            .help =                                                                                \
                "samples that hold no value, up to 4 with commas: zero, max (255 or 65535), or "   \
                "numbers as in --invalid=-16; NaN and infinity never do, nor in distances zero, "  \
                "and 65535 if less than a hundredth has it"                                        \
    }
#define REPAIR_OPTIONS(type, member)                                                               \
    INVALID_OPTION(type, member),                                                                  \
    {                                                                                              \
        OPTION(OPTION_INTEGER, "--speckle", "N", type, member.speckle),                            \
            .least = 0, .greatest = REFOCUS_MAX_SPECKLE,                                           \
            .help = "fill patches of fewer than N samples like holes; default 0: none"             \
    }

/* These return exit codes and print why it is not EXIT_DONE. */

/* Whether depth is to be made of pictures by `model`, `right` or `stereo`. */
bool input_depth_is_made(const struct depth_settings *settings);

/* Called before anything is read. */
int input_check_depth(const struct depth_settings *settings);

/* Read a photo into a new input, which it names; ended by input_free(), also after an
 * error. What to give instead of a depth map ends the words of that error. */
int input_read_photo(struct input *input, const char *photo, const char *instead);
/* Likewise the left picture of a pair, whose other one may be within the same file. */
int input_read_left(struct input *input, const char *left, bool within);
/* Likewise a photo, without the line of input_tell_bits(). */
int input_take_photo(struct input *input, const char *photo, const char *instead);

/* Print one line where a photo has more than the 8 bits a channel that are rendered. */
void input_tell_bits(const struct refocus_photo *photo, const char *name);

/* Read a photo and its depth; ended by input_free(), also after an error. */
int input_read(struct input *input, const char *photo, const struct depth_settings *settings);

/* Read a depth file, or the depth of a photo; input->photo is NULL afterwards. */
int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings);
/* Put --near, --far and --depth-unit over what the photo says about its own depth. */
int input_settle_embedded(struct input *input, const struct depth_settings *settings);

void input_free(struct input *input);

/* null, or the matte's file, size, and the parts of it that are subject, and mixed. */
json_t *input_matte_json(const struct input *input);

/* The photo and a map of its depth, with the matte if there is one, which all stay the caller's. */
struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map);

/* The exit code for a status of the file library. */
int input_exit_code(int status);

#endif
