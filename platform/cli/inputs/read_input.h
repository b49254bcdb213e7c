/* read_input.h: reads a photo and its disparities as the options ask for them. */
#ifndef RF_CLI_READ_INPUT_H
#define RF_CLI_READ_INPUT_H

#include "inputs/disparities.h"
#include "inputs/input.h"
#include "line/option.h"

/* Words of --gain-map. */
extern const struct option_word gain_map_words[];

/* These return exit codes and print why it is not EXIT_DONE. */

/* Whether depth is to be made of pictures by `model`, `right` or `stereo`. */
bool input_depth_is_made(const struct depth_settings *settings);

/* Called before anything is read. */
int input_check_depth(const struct depth_settings *settings);

/* Read a photo into a new input, which it names; ended by input_free(), also after an
 * error. What to give instead of a depth map ends the words of that error. */
int input_read_photo(struct input *input, const char *photo, const char *instead);
/* Likewise the left picture of a pair, whose other one may be within the same file. */
int input_read_left(struct input *input, const char *left, bool within);
/* Likewise a photo, without the line of input_tell_bits(). */
int input_take_photo(struct input *input, const char *photo, const char *instead);

/* Print one line where a photo has more than the 8 bits a channel that are rendered. */
void input_tell_bits(const struct refocus_photo *photo, const char *name);

/* Read a photo and its depth; ended by input_free(), also after an error. */
int input_read(struct input *input, const char *photo, const struct depth_settings *settings);

/* Read a depth file, or the depth of a photo; input->photo is NULL afterwards. */
int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings);
/* Put --near, --far and --depth-unit over what the photo says about its own depth. */
int input_settle_embedded(struct input *input, const struct depth_settings *settings);

void input_free(struct input *input);

/* null, or the matte's file, size, and the parts of it that are subject, and mixed. */
json_t *input_matte_json(const struct input *input);

/* The photo and a map of its depth, with the matte if there is one, which all stay the caller's. */
struct refocus_scene input_scene(const struct input *input, const struct refocus_disparity *map);

/* The exit code for a status of the file library. */
int input_exit_code(int status);

#endif
