/* commands.h: the list of subcommands; each is in a file of its own. */
#ifndef RF_CLI_COMMANDS_H
#define RF_CLI_COMMANDS_H

#include "line/subcommands.h"
#include "line/options.h"

extern const struct command render_command;
extern const struct command depth_command;
extern const struct command stack_command;
extern const struct command info_command;
extern const struct command bench_command;
extern const struct command pull_command;
extern const struct command sheet_command;
extern const struct command compare_command;
extern const struct command live_command;
extern const struct command view_command;
extern const struct command serve_command;
/* The command depth, whose report and errors call a focus stack so where its files do not stay. */
int depth_run(int argc, char **argv, const char *called);
/* The command serve, and its page in a browser. */
int serve_in_browser(int argc, char **argv);

#endif
