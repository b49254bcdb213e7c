/* options.c: a command line is parsed by a table of options. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "line/help.h"
#include "line/options.h"
#include "line/report.h"

enum { LONGEST_WORD = 63 };

static bool asks_help(int argc, char **argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "-h") == 0 || strncmp(argv[i], "--help", 6) == 0)
            return true;
    return false;
}

static int load(const struct command *command, const struct option *row, int argc, char **argv,
                void *settings)
{
    const size_t length = strlen(row->name);
    int status = OPTIONS_PARSED;
    bool given = false;

    for (int i = 1; status == OPTIONS_PARSED && i < argc && strcmp(argv[i], "--") != 0; i++) {
        const char *file = NULL;

        if (strcmp(argv[i], row->name) == 0 && i + 1 < argc)
            file = argv[i + 1];
        else if (strncmp(argv[i], row->name, length) == 0 && argv[i][length] == '=')
            file = argv[i] + length + 1;
        if (!file)
            continue;
        given = true;
        status = row->load(command, file, settings);
    }
    if (given || !row->unless || options_given(command, argc, argv, row->unless) ||
        asks_help(argc, argv))
        return status;
    return row->load(command, NULL, settings);
}

void options_clear_rivals(const struct command *command, const struct option *option,
                          void *settings)
{
    for (const struct option *rival = options_of(command); rival->help && option->group; rival++) {
        double *value = (double *)(void *)((char *)settings + rival->offset);

        if (rival != option && rival->group && strcmp(rival->group, option->group) == 0)
            for (int i = 0; i < (rival->kind == OPTION_NUMBERS ? rival->count : 1); i++)
                value[i] = NAN;
    }
}

/* Files with values of options come before all else on the command line, which overrules them. */
static int load_files(const struct command *command, int argc, char **argv, void *settings)
{
    int status = OPTIONS_PARSED;

    for (const struct option *row = options_of(command); row->help && status == OPTIONS_PARSED;
         row++)
        if (row->load)
            status = load(command, row, argc, argv, settings);
    for (const struct option *row = options_of(command); row->help && status == OPTIONS_PARSED;
         row++)
        if (row->group && options_given(command, argc, argv, row->name))
            options_clear_rivals(command, row, settings);
    return status;
}

static int unknown_option(const struct command *command, const char *argument)
{
    char name[LONGEST_WORD + 1];
    const char *nearest;

    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    nearest = options_nearest_name(command, name);
    if (nearest)
        return report_failure(EXIT_WRONG, name, "unknown option; did you mean %s?", nearest);
    if (access(argument, F_OK) == 0)
        return report_failure(EXIT_WRONG, argument,
                              "unknown option; a file of this name is given as ./%s", argument);
    return report_failure(EXIT_WRONG, name, "unknown option; 'refocus %s --help-all' lists them",
                          command->name);
}

/* Parse the option at argv[*i]; *i moves on over its value. */
static int parse_option(const struct command *command, int argc, char **argv, int *i,
                        void *settings)
{
    const char *value;
    const struct option *option = options_at(command, argv[*i], &value);

    if (!option)
        return unknown_option(command, argv[*i]);
    if (option->kind == OPTION_FLAG) {
        if (value)
            return report_failure(EXIT_WRONG, option->name, "takes no value; leave '=%s' out",
                                  value);
        return options_set(option, option->name, "", settings);
    }
    if (!value && *i + 1 < argc && strncmp(argv[*i + 1], "--", 2) != 0)
        value = argv[++*i];
    if (!value)
        return report_failure(EXIT_WRONG, option->name, "has no value; give %s", option->argument);
    return options_set(option, option->name, value, settings);
}

/* Print the help that an argument asks for; false when it asks for none. */
static bool print_help(const struct command *command, const char *argument)
{
    if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0)
        options_print_help(command);
    else if (strcmp(argument, "--help-all") == 0)
        options_print_all_help(command);
    else
        return false;
    return true;
}

int options_parse(const struct command *command, int argc, char **argv, void *settings,
                  const char **files)
{
    int count = 0, loaded = load_files(command, argc, argv, settings);
    bool names_only = false;

    if (loaded != OPTIONS_PARSED)
        return loaded;

    for (int i = 1; i < argc; i++) {
        if (!names_only && argv[i][0] == '-' && argv[i][1] != '\0') {
            if (strcmp(argv[i], "--") == 0) {
                names_only = true;
                continue;
            }
            if (print_help(command, argv[i]))
                return report_end_output();
            const int status = parse_option(command, argc, argv, &i, settings);
            if (status != OPTIONS_PARSED)
                return status;
            continue;
        }
        if (count == command->files_most && command->too_many)
            return report_failure(EXIT_WRONG, argv[i], "%s", command->too_many);
        if (count == command->files_most)
            return report_failure(EXIT_WRONG, argv[i], "one file too many; give refocus %s %s",
                                  command->name, command->usage);
        if (argv[i][0] == '\0')
            return report_failure(EXIT_WRONG, command->name,
                                  "a file name is empty; give refocus %s %s", command->name,
                                  command->usage);
        files[count++] = argv[i];
    }
    if (count < command->files_least)
        return report_failure(EXIT_WRONG, command->name, "no file; give refocus %s %s",
                              command->name, command->usage);
    files[count] = NULL;
    return options_check_needs(command, argc, argv, settings);
}
