/* estimate.h: depth that is estimated from pictures: of a stereo pair, or by a network. */
#ifndef RF_CLI_ESTIMATE_H
#define RF_CLI_ESTIMATE_H

#include "inputs/read_input.h"

/* Read a photo and make its depth: from it and the right one of a stereo pair, which is NULL when
 * they lie side by side in one picture, or within the file as two pictures; or by a network. These
 * return exit codes and print why. */
int input_read_stereo(struct input *input, const char *left, const char *right,
                      const struct stereo_settings *how, const struct depth_settings *settings);
int input_read_estimate(struct input *input, const char *photo, const char *model,
                        const struct network_settings *network,
                        const struct depth_settings *settings);

/* Make the depth of a photo that was read, by the settings' `model` or else `right` and `stereo`.
 * It is what `make` of the settings points to. */
int input_estimate_depth(struct input *input, const struct depth_settings *settings);

#endif
