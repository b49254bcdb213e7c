/* behind.h: a second layer: a picture of what the photo hides, and its depth. */
#ifndef RF_CLI_BEHIND_H
#define RF_CLI_BEHIND_H

#include "inputs/read_input.h"

struct behind_settings {
    const char *image, *depth; /* files, or NULL */
};

/* Rows for tables of options, where the settings have a member of the type above. */
#define BEHIND_OPTIONS(type, member)                                                               \
    {OPTION(OPTION_TEXT, "--behind", "IMAGE", type, member.image), .needs = "--behind-depth",      \
     .help = "what the photo hides, where that is known: a picture of the photo's size, which is " \
             "shown where a blurred foreground uncovers it"},                                      \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--behind-depth", "MAP", type, member.depth),                          \
            .needs = "--behind",                                                                   \
            .help = "depth map of IMAGE, of its size, in the units and between the distances of "  \
                    "the photo's; counts where it is farther than that"                            \
    }

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
