/* Words for depth that is made of pictures. */
#ifndef RF_CLI_MADE_H
#define RF_CLI_MADE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <refocus/refocus.h>

/* Ways of --upsample: "core" and those of OpenCV; NULL ends them. */
const char *made_upsampler(uint32_t index);
/* One of those of OpenCV, to width x height of the photo; an exit code, and prints
 * why. */
int made_upsample(uint32_t filter, const struct refocus_image *photo,
                  const struct refocus_disparity *map, uint16_t *out, const char *name);

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
};

/* Presets of --preset; NULL ends them. */
const char *made_preset(uint32_t index);

#endif
