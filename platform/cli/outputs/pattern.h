/* pattern.h: names of files in which {name}, {ext}, {n} and the names of options stand for what
 * they are for one photo of several. "{{" is a brace. */
#ifndef RF_CLI_PATTERN_H
#define RF_CLI_PATTERN_H

#include "line/option.h"

struct pattern_values {
    const struct command *command;
    const void *settings;    /* values of its options */
    const char *photo, *ext; /* {name} is the photo's name without folder and ending */
    int number, count;       /* {n}: number, from 1, with as many digits as count has */
};

bool pattern_is(const char *text);

/* Put the values in; *expanded is to be freed, and NULL after an error, which is EXIT_WRONG and
 * says where the pattern was given, or EXIT_FAILED without memory. */
int pattern_expand(const char *where, const char *pattern, const struct pattern_values *values,
                   char **expanded);

#endif
