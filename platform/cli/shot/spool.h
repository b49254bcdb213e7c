/* spool.h: a picture waits in a temporary file while its photo is in memory. */
#ifndef RF_CLI_SPOOL_H
#define RF_CLI_SPOOL_H

#include <refocus/image.h>

/* Make the file, in TMPDIR or /var/tmp, under no name: it ends with its descriptor, which is
 * returned; -1 if there can be none. */
int spool_open(void);

/* Add rows of a packed picture of `height` rows to the file's end. Returns an exit status and has
 * reported failure, about the photo of this name, when it is not EXIT_DONE. */
int spool_put(int file, const char *photo, int height, const struct refocus_image *rows);

/* Fill a packed picture from the file's beginning. Returns and reports as spool_put() does. */
int spool_get(int file, const char *photo, const struct refocus_image *picture);

#endif
