/* estimate_options.h: options that say how depth is estimated from pictures. */
#ifndef RF_CLI_ESTIMATE_OPTIONS_H
#define RF_CLI_ESTIMATE_OPTIONS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include "inputs/opencv.h"
#include "line/option.h"

/* How --estimate feeds its network; NAN: as the preset and the file say. */
struct network_settings {
    int preset;
    double size[2], mean[3], scale;
    bool inverse;
};
#define NETWORK_SETTINGS_NONE                                                                      \
    {                                                                                              \
        0, {NAN, NAN}, {NAN, NAN, NAN}, NAN, false                                                 \
    }

/* How a pair is matched. */
struct stereo_settings {
    bool within; /* both pictures are in the one file */
    int method;  /* enum refocus_stereo_method */
    int order;   /* index of stereo_order_words */
};

/* Words of --match and --pair-order. */
extern const struct option_word stereo_match_words[], stereo_order_words[];

/* Rows for tables of options: `model` is a text, `network` and `stereo` are the settings above,
 * short_help is a line of --help or NULL. */
#define ESTIMATE_OPTIONS(type, model, network, short_help)                                         \
    {OPTION(OPTION_TEXT, "--estimate", "MODEL.onnx", type, model), .brief = short_help,            \
     .help = "depth of the one photo, by a network"},                                              \
        {OPTION(OPTION_CHOICE, "--network", "NAME", type, network.preset),                         \
         .choice = opencv_network_name,                                                            \
         .help = "which network it is: range of its input, and its size where the file "           \
                 "leaves it open",                                                                 \
         .needs = "--estimate"},                                                                   \
        {OPTION(OPTION_NUMBERS, "--input-size", "W,H", type, network.size),                        \
         .least = 32,                                                                              \
         .greatest = 2048,                                                                         \
         .count = 2,                                                                               \
         .help = "of the picture that the network takes; default: what the file says, else "       \
                 "that of --network",                                                              \
         .needs = "--estimate"},                                                                   \
        {OPTION(OPTION_NUMBERS, "--input-mean", "R,G,B", type, network.mean),                      \
         .least = -1000,                                                                           \
         .greatest = 1000,                                                                         \
         .count = 3,                                                                               \
         .decimals = true,                                                                         \
         .help = "codes that the network takes as 0; default: those of --network",                 \
         .needs = "--estimate"},                                                                   \
        {OPTION(OPTION_NUMBER, "--input-scale", "S", type, network.scale), .least = -1000,         \
         .greatest = 1000,                                                                         \
         .help = "worth of a code: value = (code - mean) S; default: that of --network",           \
         .needs = "--estimate"},                                                                   \
    {                                                                                              \
        OPTION(OPTION_FLAG, "--far-is-large", NULL, type, network.inverse),                        \
            .help = "the network gives distances: larger = farther", .needs = "--estimate"         \
    }
#define STEREO_FILE_OPTION(type, stereo, short_help)                                               \
    {                                                                                              \
        OPTION(OPTION_FLAG, "--stereo-file", NULL, type, stereo.within),                           \
            .brief = short_help,                                                                   \
            .help = "the photo's file holds both pictures of a stereo pair: an MPO, two JPEGs or " \
                    "a stereo HEIC"                                                                \
    }
#define MATCH_OPTION(type, stereo, short_help)                                                     \
    OPTION(OPTION_CHOICE, "--match", "HOW", type, stereo.method),                                  \
        .brief = short_help, .words = stereo_match_words, .help = "how a stereo pair is matched"
#define PAIR_ORDER_OPTION(type, stereo)                                                            \
    OPTION(OPTION_CHOICE, "--pair-order", "HOW", type, stereo.order),                              \
        .words = stereo_order_words, .help = "which picture of a stereo pair is the first one"

#endif
