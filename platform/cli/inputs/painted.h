/* painted.h: depth that is painted by a file of strokes over a photo. */
#ifndef RF_CLI_PAINTED_H
#define RF_CLI_PAINTED_H

#include "inputs/read_input.h"

/* Read a photo without any depth, for strokes to be painted over; or go on with one
 * that was read. */
int painted_read(struct input *input, const char *photo, const struct depth_settings *settings);
void painted_begin(struct input *input, const struct depth_settings *settings);

/* Paint the strokes of a file over the disparities, which have the photo's size, or over nothing
 * when there are none yet. */
int painted_apply(struct input *input, const char *file);
/* Paint the strokes of the settings, if any, after input_read(), which may have found no depth. */
int painted_over(struct input *input, const struct depth_settings *settings);

#endif
