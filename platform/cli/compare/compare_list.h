/* compare_list.h: the methods that `refocus compare` renders, each with options of its own. */
#ifndef RF_CLI_COMPARE_LIST_H
#define RF_CLI_COMPARE_LIST_H

#include "shot/engine.h"

enum { VARIANTS_MOST = 32 };

struct variant {
    const char *label; /* as on the command line: NAME or NAME:OPTION=VALUE:... */
    struct engine_settings settings;
    struct engine engine; /* parameters and aperture of the method; without a renderer */
};

struct variants {
    int count;
    struct variant variant[VARIANTS_MOST];
    char *words; /* memory of the labels and options */
};

/*
 * The list NAME[:OPTION[=VALUE]...],...; NULL: every method that knows the aperture.
 * Options are those of methods without their dashes, and the others are `common`.
 * Returns an exit code and prints why it is not EXIT_DONE; variants_end() in any case.
 */
int variants_begin(struct variants *variants, const char *list,
                   const struct engine_settings *common);
void variants_end(struct variants *variants);

#endif
