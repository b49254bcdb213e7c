/* needs.h: which options a command line gives, and options that would change nothing. */
#ifndef RF_CLI_NEEDS_H
#define RF_CLI_NEEDS_H

#include "line/option.h"

/* Whether a command line that options_parse() took gives an option, by its name. */
bool options_given(const struct command *command, int argc, char **argv, const char *name);

/* EXIT_WRONG, saying why, when that command line gives one of these options, or one beside these;
 * EXIT_DONE when it does not. Names end with NULL. */
int options_refuse(const struct command *command, int argc, char **argv, const char *const *names,
                   const char *why);
int options_refuse_beside(const struct command *command, int argc, char **argv,
                          const char *const *names, const char *why);

/* The last step of options_parse(): OPTIONS_PARSED, or EXIT_WRONG when an option is given that
 * changes nothing without another. */
int options_check_needs(const struct command *command, int argc, char **argv, const void *settings);

#endif
