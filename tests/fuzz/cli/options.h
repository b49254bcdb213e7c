/* options.h: a command with an option of every kind, and the values that it may have. */
#ifndef FUZZ_CLI_OPTIONS_H
#define FUZZ_CLI_OPTIONS_H

#include <stdbool.h>
#include "line/options.h"

struct values {
    bool flag;
    double number, several[4], whole;
    const char *text;
    int choice;
};

extern const struct command fuzz_command;

/* Ends the program when a value that was taken is out of its option's range. */
void fuzz_check_values(const struct values *values);

#endif
