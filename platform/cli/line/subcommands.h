/* subcommands.h: the list of subcommands, which is in commands/commands.c. */
#ifndef RF_CLI_SUBCOMMANDS_H
#define RF_CLI_SUBCOMMANDS_H

#include "line/option.h"

/* All of them, as the help lists them; NULL ends it. */
extern const struct command *const commands[];
const struct command *commands_find(const char *name);

#endif
