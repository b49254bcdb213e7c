/* input.h: a photo with its disparities, and the settings by which they are read. */
#ifndef RF_CLI_INPUT_H
#define RF_CLI_INPUT_H

#include <math.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "inputs/edges.h"
#include "inputs/limits.h"
#include "inputs/orient.h"
#include "inputs/upsample.h"
#include "inputs/estimate_options.h"

/* Photos of more than 8 bits that are rendered from all that they hold: none, those with light
 * above white, or all. */
enum deep { DEEP_NONE, DEEP_LIGHT, DEEP_ALL };

/* A photo's gain map makes its light, or is ignored. */
enum gain_map { GAIN_MAP_USE, GAIN_MAP_IGNORE };

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
                             of upsample_words */
    struct limit_settings limits;
    const char *model, *right; /* depth is made by a network, or of this and the photo; or NULL */
    const char *strokes;       /* a file of strokes that are painted over it, or NULL */
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
    struct refocus_stack_result stack;       /* findings; struct_size 0: it is no stack */
    struct refocus_image stacked;            /* the light of its photo; plane[0] NULL: none */
    bool has_stacked;                        /* `stacked` has light that 8 bits do not hold */
};

#endif
