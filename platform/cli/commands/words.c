/* words.c: `refocus help`, `version`, `man` and `completion`, made from the tables of options. */
#include <stdio.h>
#include <string.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include <refocus/platform/source.h>
#include "commands/commands.h"
#include "commands/words.h"
#include "line/completion.h"
#include "line/help.h"
#include "line/man.h"
#include "line/report.h"

const char *words_name(const void *unused, int i)
{
    int count = 0;

    (void)unused;
    while (commands[count])
        count++;
    return i < count ? commands[i]->name : words[i - count].name;
}

const struct word *words_find(const char *name)
{
    static const char *const other_names[][2] = {
        {"--help", "help"},       {"-h", "help"},    {"--help-all", "help"},
        {"--version", "version"}, {"-V", "version"}, {"-v", "version"},
    };

    for (size_t i = 0; i < sizeof other_names / sizeof *other_names; i++)
        if (strcmp(name, other_names[i][0]) == 0)
            name = other_names[i][1];
    for (const struct word *word = words; word->name; word++)
        if (strcmp(word->name, name) == 0)
            return word;
    return NULL;
}

static void print_usage(void)
{
    puts("usage: refocus SUBCOMMAND [options] FILE...\n\n"
         "Refocus photos by their depth.\n");
    for (int i = 0; commands[i]; i++)
        printf("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    putchar('\n');
    for (const struct word *word = words; word->name; word++)
        printf("  %-10s %-14s %s\n", word->name, word->usage, word->summary);
    puts("\nExample: refocus render portrait.jpg --focus-at 1200,900 --blur 40 -o out.jpg\n\n"
         "exit status: " HELP_EXIT_STATUS);
}

/* The subcommand that a word is about, or NULL after the error. */
static const struct command *subcommand(const char *word, const char *name)
{
    const struct command *command = commands_find(name);
    const char *nearest = command ? NULL : options_nearest(name, words_name, NULL);

    if (!command)
        report_failure(EXIT_WRONG, word, "'%s' is no subcommand%s%s%s", name,
                       nearest ? "; did you mean '" : "; 'refocus --help' lists them",
                       nearest ? nearest : "", nearest ? "'?" : "");
    return command;
}

static int help(int argc, char **argv)
{
    const struct command *command;

    if (argc < 2 || argv[0][0] == '-' || words_find(argv[1])) {
        print_usage();
        return report_end_output();
    }
    if ((command = subcommand(argv[0], argv[1])) == NULL)
        return EXIT_WRONG;
    options_print_help(command);
    return report_end_output();
}

static int version(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    printf("refocus %s\nfiles: %s\n", refocus_version(), refocus_file_formats());
    printf("sources: %s\n", refocus_source_backends());
#ifdef RF_HAVE_OPENCV
    puts("depth: files strokes OpenCV");
#else
    puts("depth: files strokes");
#endif
    return report_end_output();
}

static int man(int argc, char **argv)
{
    const struct command *command = NULL;

    if (argc > 1 && (command = subcommand(argv[0], argv[1])) == NULL)
        return EXIT_WRONG;
    if (command) {
        man_print_command(command, commands);
        return report_end_output();
    }
    man_print_beginning("refocus", "refocus photos by their depth");
    man_print_synopsis("refocus", "SUBCOMMAND [options] FILE...");
    man_print_section("SUBCOMMANDS");
    for (int i = 0; commands[i]; i++)
        man_print_item(commands[i]->name, commands[i]->usage, commands[i]->summary);
    man_print_section("ABOUT THE COMMAND");
    for (const struct word *word = words; word->name; word++)
        man_print_item(word->name, word->usage, word->summary);
    man_print_end(commands, NULL);
    return report_end_output();
}

static int completion(int argc, char **argv)
{
    const char *names[32];
    size_t count = 0;

    for (const struct word *word = words; word->name; word++)
        names[count++] = word->name;
    names[count] = NULL;
    if (argc != 2 || !completion_print(argv[1], commands, names))
        return report_failure(EXIT_WRONG, argv[0], "give the shell: bash, zsh or fish");
    return report_end_output();
}

const struct word words[] = {
    {"help", "[SUBCOMMAND]", "this text, or that of one; --help-all has the rest", help},
    {"version", "", "version and parts of this build; also -V, --version", version},
    {"man", "[SUBCOMMAND]", "a manual page, for man -l -", man},
    {"completion", "bash|zsh|fish", "what completes command lines in that shell", completion},
    {NULL, NULL, NULL, NULL},
};
