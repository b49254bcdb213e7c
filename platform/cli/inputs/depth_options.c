/* depth_options.c: the options of depth, which commands have as groups. */
#include "inputs/depth_options.h"

#include "inputs/read_input.h"
#include "inputs/transfer.h"

const struct option depth_file_options[] = {
    {OPTION(OPTION_TEXT, "--depth", "FILE", struct depth_settings, file),
     .brief = "depth map; without it the one that the photo carries",
     .help = "depth map: PNG, PGM or JPEG of 8 or 16 bits, PFM, NumPy's .npy or .npz, or a photo "
             "that carries one; without it the depth that the photo itself carries"},
    {.help = NULL},
};

const struct option depth_unit_options[] = {
    {OPTION(OPTION_TEXT, "--depth-unit", "U", struct depth_settings, unit),
     .brief = "disparity (bright = near), inverse, mm, m, or 5000/m",
     .help = "what its samples are: disparity (bright = near), inverse (dark = near), disparity/16 "
             "(16ths of a pixel, range measured), mm, m, or a number per metre such as 5000/m; "
             "default: what the file says, else disparity"},
    {OPTION(OPTION_NUMBER, "--near", "M", struct depth_settings, near_m), .least = 0, .above = true,
     .greatest = 1e9,
     .help = "metres of disparity 1; default: what the file says, else what is measured in "
             "distances, without single samples far nearer than all others"},
    {OPTION(OPTION_NUMBER, "--far", "M", struct depth_settings, far_m), .least = 0, .above = true,
     .greatest = INFINITY, .help = "metres of disparity 0, also 'inf'; default as for --near"},
    {.help = NULL},
};

const struct option depth_ways_options[] = {
    ESTIMATE_OPTIONS(struct depth_settings, model, network, NULL),
    {OPTION(OPTION_TEXT, "--stereo", "RIGHT", struct depth_settings, right),
     .help = "depth of the photo and the right picture of its stereo pair"},
    STEREO_FILE_OPTION(struct depth_settings, stereo, NULL),
    {MATCH_OPTION(struct depth_settings, stereo, NULL), .needs = "--stereo,--stereo-file"},
    {PAIR_ORDER_OPTION(struct depth_settings, stereo), .needs = "--stereo,--stereo-file"},
    {OPTION(OPTION_TEXT, "--strokes", "FILE.json", struct depth_settings, strokes),
     .help = "depth by strokes, over the other depth that there is, or over nothing; the page of "
             "refocus serve saves them"},
    {.help = NULL},
};

const struct option depth_edges_options[] = {
    {OPTION(OPTION_CHOICE, "--depth-edges", "HOW", struct depth_settings, edges),
     .words = edges_words, .help = "the edges of the depth map"},
    {.help = NULL},
};

const struct option orient_depth_options[] = {
    {OPTION(OPTION_CHOICE, "--orient-depth", "DEGREES", struct depth_settings, orient),
     .words = orient_words, .help = "turn the depth map clockwise; default auto"},
    {.help = NULL},
};

const struct option upsample_options[] = {
    {OPTION(OPTION_CHOICE, "--upsample", "HOW", struct depth_settings, upsample),
     .words = upsample_words,
     .help = "how a map of another size gets the photo's, before --depth-edges: by the library "
             "(default), or by filters of OpenCV, the last three by its module refocus-ximgproc"},
    {.help = NULL},
};

const struct option light_options[] = {
    {OPTION(OPTION_CHOICE, "--gain-map", "HOW", struct depth_settings, gain_map),
     .words = gain_map_words, .omits_default = true,
     .help = "the gain map of a photo (Ultra HDR, ISO 21496-1, Apple); default use"},
    {OPTION(OPTION_FLAG, "--no-dither", NULL, struct depth_settings, no_dither),
     .help = "photos of more than 8 bits, or with a gain map: 8 bits of the result are rounded"},
    {OPTION(OPTION_CHOICE, "--transfer", "CURVE", struct depth_settings, transfer),
     .words = transfer_words, .omits_default = true,
     .help = "how a photo of more than 8 bits stores light; default auto"},
    {OPTION(OPTION_NUMBER, "--white", "LIGHT", struct depth_settings, white), .least = 1 / 65536.0,
     .greatest = 65536,
     .help = "light of such a photo that is shown as white, cd/m2 with pq; what is brighter keeps "
             "its light out of focus; default 1, 203 with pq, 0.265 with hlg"},
    {.help = NULL},
};

const struct option matte_options[] = {
    {OPTION(OPTION_TEXT, "--matte", "FILE|none", struct depth_settings, matte),
     .help = "how much of each pixel is subject: a grey PNG, PGM or JPEG of 8 or 16 bits, white = "
             "subject; its edges and hair are drawn by it (sweep); default: the portrait matte of "
             "the photo, if it has one; none: no matte"},
    {.help = NULL},
};

const struct option invalid_options[] = {
    {OPTION(OPTION_TEXT, "--invalid", "CODES", struct depth_settings, invalid),
     .help = "samples that hold no value, up to 4 with commas: zero, max (255 or 65535), or "
             "numbers as in --invalid=-16; NaN and infinity never do, nor in distances zero, and "
             "65535 if less than a hundredth has it"},
    {.help = NULL},
};

const struct option repair_options[] = {
    GROUP_HERE(invalid_options),
    {OPTION(OPTION_INTEGER, "--speckle", "N", struct depth_settings, speckle), .least = 0,
     .greatest = REFOCUS_MAX_SPECKLE,
     .help = "fill patches of fewer than N samples like holes; default 0: none"},
    {.help = NULL},
};
