/* editable.h: whether a result holds its all-in-focus original and depth, and what they are. */
#ifndef RF_CLI_EDITABLE_H
#define RF_CLI_EDITABLE_H

#include <stdbool.h>
#include "inputs/read_input.h"
#include "line/option.h"

struct keep_settings {
    bool strip, editable, no_editable;
};

/* The options of struct keep_settings. */
extern const struct option keeping_options[];

/* Check before the work that they go together with each other, the name of the output, and a
 * picture that is the whole photo, refocused, or is not. */
int keep_check(const struct keep_settings *settings, const char *output, bool whole);

/* Whether a result holds the light beyond white that it was rendered in. */
bool keep_has_light(const struct keep_settings *settings, const char *output);

/* The structs that a writer of an editable picture takes, which point at each other. */
struct editable {
    struct refocus_editable given;
    struct refocus_depth_write depth;
    struct refocus_write_options options;
};

/* Fill editable->options: what is kept of the photo. `input` with its depth is as input_read() left
 * it. */
int keep_options(const struct keep_settings *settings, const struct input *input,
                 const struct depth_settings *depth, const char *output, bool whole,
                 const struct refocus_render_params *lens, struct editable *editable);

#endif
