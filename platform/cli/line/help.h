/* help.h: the help of a command. */
#ifndef RF_CLI_HELP_H
#define RF_CLI_HELP_H

#include "line/option.h"

void options_print_help(const struct command *command);

#endif
