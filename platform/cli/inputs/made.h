/* made.h: depth that is made of pictures: of a stereo pair, or by a network. */
#ifndef RF_CLI_MADE_H
#define RF_CLI_MADE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include "inputs/inputs.h"

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

/* Words of --preset; NULL ends them. */
const char *made_preset(uint32_t index);

/* Read a photo and make its depth: from it and the right one of a stereo pair, which is NULL when
 * they lie side by side in one picture, or within the file as two pictures; or by a network. These
 * return exit codes and print why. */
int input_read_stereo(struct input *input, const char *left, const char *right,
                      const struct stereo_settings *how, const struct depth_settings *settings);
int input_read_estimate(struct input *input, const char *photo, const char *model,
                        const struct network_settings *network,
                        const struct depth_settings *settings);

#endif
