/* behind.h: a second layer: a picture of what the photo hides, and its depth. */
#ifndef RF_CLI_BEHIND_H
#define RF_CLI_BEHIND_H

#include "inputs/read_input.h"

struct behind_settings {
    const char *image, *depth; /* files, or NULL */
};

/* The options of struct behind_settings. */
extern const struct option behind_options[];

/* The layer; struct_size 0: there is none. */
struct behind {
    struct refocus_photo *photo;
    struct input depth;
    struct refocus_image image;
    struct refocus_disparity disparity;
};

/* Read the files for a photo whose depth was read; an exit code, and prints why. Ended by
 * behind_free(), also after an error. */
int behind_read(struct behind *behind, const struct behind_settings *settings,
                const struct depth_settings *depth, const struct input *input);

/* Make the layer part of a scene, if there is one. */
void behind_add(const struct behind *behind, struct refocus_scene *scene);

void behind_free(struct behind *behind);

#endif
