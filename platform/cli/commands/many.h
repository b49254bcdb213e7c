/* many.h: the names of what is read and written for each of several photos. */
#ifndef RF_CLI_MANY_H
#define RF_CLI_MANY_H

#include "line/jobs.h"
#include "line/option.h"

struct many_photo {
    const char *photo;
    char *output, *depth, *matte; /* NULL: none */
};

struct many {
    struct many_photo *photos;
    int count;
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Make the names from those of the command line, which may be patterns; the output may be a folder.
 * `files` are the photos and end with NULL, `settings` holds the values of the command's options;
 * ext is {ext}, or NULL for the photo's own. Ended by many_free(), whatever it returned. */
int many_name(struct many *many, const struct command *command, const void *settings,
              const char *const *files, const char *output, const char *ext, const char *depth,
              const char *matte);

/* Check that each output has a place of its own, and that none is what another photo is made of. */
int many_check(const struct many *many);

void many_free(struct many *many);

#endif
