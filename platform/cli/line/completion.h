/* completion.h: scripts by which shells complete command lines, from the tables of options. */
#ifndef RF_CLI_COMPLETION_H
#define RF_CLI_COMPLETION_H

#include "line/option.h"

/* Print the script of a shell, "bash", "zsh" or "fish", for these subcommands and for words in
 * their place that take no options, both ended by NULL; false: the shell is not known. */
bool completion_print(const char *shell, const struct command *const *commands,
                      const char *const *words);

#endif
