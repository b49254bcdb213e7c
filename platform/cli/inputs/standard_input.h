/* standard_input.h: a photo from standard input, which files named "-" stand for. */
#ifndef RF_CLI_STANDARD_INPUT_H
#define RF_CLI_STANDARD_INPUT_H

#include <stdbool.h>
#include <refocus/platform/file.h>

bool standard_is(const char *name);

/* Read a photo from a file, or from standard input, which is read once: as refocus_photo_read(). */
int standard_photo(struct refocus_photo **photo, const char *name, struct refocus_reason *reason);

/* Read a photo that is read once more: the bytes of standard input stay. */
int standard_look(struct refocus_photo **photo, const char *name, struct refocus_reason *reason);

/* Read a photo, or a depth map that is none; a grey picture without depth may be both. */
int standard_photo_or_map(struct refocus_photo **photo, const char *name,
                          struct refocus_reason *reason);

/* The ending, without a dot, of the format that a file or standard input begins as; "jpg" where it
 * is none that is written, or cannot be read. */
const char *standard_ending(const char *name);

#endif
