/* shot.h: one photo is refocused by the settings. Nothing here knows GEGL. */
#ifndef RF_GEGL_SHOT_H
#define RF_GEGL_SHOT_H

#include <stddef.h>
#include <refocus/refocus.h>
#include "settings.h"

struct rf_gegl_shot {
    const struct rf_gegl_settings *settings;
    const struct refocus_image *photo;
    const float *depth; /* NaN: no value */
    int depth_width, depth_height;
    int threads;
    int x, y; /* corner of the part that is rendered, whose size `out` has */
    const struct refocus_image *out;
};

enum { RF_GEGL_WORDS = 256 };

/* Refocus a photo. On an error `why` says so in a line. Without a deep format `out` may lie in the
 * memory of the photo. */
int rf_gegl_shot_take(const struct rf_gegl_shot *shot, char why[RF_GEGL_WORDS]);

#endif
