/* options.h: a command line is parsed by a table of options. */
#ifndef RF_CLI_OPTIONS_H
#define RF_CLI_OPTIONS_H

#include "line/needs.h"
#include "line/option.h"

/*
 * Parse argv[1] and on into settings; names of files are moved to files[], which ends with NULL.
 * Returns OPTIONS_PARSED, or the exit code after --help or an error, which it printed.
 */
int options_parse(const struct command *command, int argc, char **argv, void *settings,
                  const char **files);

/* Take away what other options of its group say. */
void options_clear_rivals(const struct command *command, const struct option *option,
                          void *settings);

#endif
