/* help.h: the help of a command, short and whole. */
#ifndef RF_CLI_HELP_H
#define RF_CLI_HELP_H

#include "line/option.h"

/* The options that most need, on a screen of 24 lines; and all of them. */
void options_print_help(const struct command *command);
void options_print_all_help(const struct command *command);

/* The end of every help and manual page. */
#define HELP_EXIT_STATUS "0 done, 1 it could not be done, 2 the command line is wrong"

/* The text behind the name of an option: its help, range and words; those that have a line
 * of their own by options_summary() are not in it. Room for `size` bytes. */
enum { HELP_LENGTH = 1024 };
void help_text(const struct option *option, char *text, size_t size);

#endif
