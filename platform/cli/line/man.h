/* man.h: manual pages, in the macros of man(7), from the tables of options. */
#ifndef RF_CLI_MAN_H
#define RF_CLI_MAN_H

#include "line/option.h"

/* The page of one of the commands, from beginning to end. */
void man_print_command(const struct command *command, const struct command *const *commands);

/* Parts of a page: what stands before its sections, what is written on the command line, a section,
 * a word with what follows it and a line on it, and the exit status with the other pages: those of
 * `commands`, ended by NULL, and of the whole, which `self` is not among. */
void man_print_beginning(const char *name, const char *summary);
void man_print_synopsis(const char *name, const char *usage);
void man_print_section(const char *title);
void man_print_item(const char *word, const char *usage, const char *text);
void man_print_end(const struct command *const *commands, const struct command *self);

#endif
