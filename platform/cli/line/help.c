/* help.c: the help of a command is printed from its table of options. */
#include <stdio.h>
#include <string.h>
#include "line/help.h"

enum { HELP_COLUMN = 26, HELP_WIDTH = 80 };

/* Print text from the present column on in lines of HELP_WIDTH, indented. */
static void print_wrapped(const char *text, int column, int indent)
{
    while (*text) {
        const int word = (int)strcspn(text, " \n");

        if (column + 1 + word > HELP_WIDTH && column > indent) {
            printf("\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            putchar(' ');
            column++;
        }
        printf("%.*s", word, text);
        column += word;
        text += word;
        if (*text == '\n') {
            printf("\n%*s", indent, "");
            column = indent;
        }
        text += *text != '\0';
    }
    putchar('\n');
}

/* Add ": a, b, c" with the words of a choice. */
static void add_words(const struct option *option, char *text, size_t size)
{
    for (uint32_t i = 0; options_word(option, i); i++)
        snprintf(text + strlen(text), size - strlen(text), "%s%s", i == 0 ? ": " : ", ",
                 options_word(option, i));
}

void help_text(const struct option *option, char *text, size_t size)
{
    char range[OPTION_RANGE_LENGTH];

    if (option->kind == OPTION_NUMBER || option->kind == OPTION_INTEGER)
        snprintf(text, size, "%s (%s)", option->help, options_range(option, range));
    else
        snprintf(text, size, "%s", option->help);
    if (option->kind == OPTION_CHOICE && !options_summary(option, 0))
        add_words(option, text, size);
}

/* "  -o, --output OUT", and blanks or a line's end up to the column of the text. */
static void print_name(const struct option *option)
{
    int n = option->letter ? printf("  -%c, %s", option->letter, option->name)
                           : printf("  %s", option->name);

    if (option->argument)
        n += printf(" %s", option->argument);
    if (n > HELP_COLUMN - 2) {
        putchar('\n');
        n = 0;
    }
    printf("%*s", HELP_COLUMN - n, "");
}

static void print_option(const struct option *option)
{
    char text[HELP_LENGTH];

    if (option->kind == OPTION_HEADING) {
        printf("\n%s\n", option->help);
        return;
    }
    print_name(option);
    help_text(option, text, sizeof text);
    print_wrapped(text, HELP_COLUMN, HELP_COLUMN);
    if (options_summary(option, 0))
        for (uint32_t i = 0; options_word(option, i); i++) {
            printf("%*s%-13s", HELP_COLUMN + 2, "", options_word(option, i));
            print_wrapped(options_summary(option, i), HELP_COLUMN + 15, HELP_COLUMN + 15);
        }
}

static void print_brief(const struct option *option)
{
    char text[HELP_LENGTH];

    print_name(option);
    snprintf(text, sizeof text, "%s", option->brief);
    if (option->kind == OPTION_CHOICE)
        add_words(option, text, sizeof text);
    print_wrapped(text, HELP_COLUMN, HELP_COLUMN);
}

static void print_usage(const struct command *command)
{
    printf("usage: refocus %s %s\n\n", command->name, command->usage);
    print_wrapped(command->summary, 0, 0);
}

void options_print_help(const struct command *command)
{
    print_usage(command);
    putchar('\n');
    for (const struct option *option = options_of(command); option->help; option++)
        if (option->brief)
            print_brief(option);
    printf("All options, with ranges and defaults: refocus %s --help-all\n", command->name);
}

void options_print_all_help(const struct command *command)
{
    print_usage(command);
    for (const struct option *option = options_of(command); option->help; option++)
        print_option(option);
    printf("  -h, --help%*sthe options that most need\n", HELP_COLUMN - 12, "");
    printf("  --help-all%*sthis text\n", HELP_COLUMN - 12, "");
    if (command->notes) {
        putchar('\n');
        print_wrapped(command->notes, 0, 0);
    }
    printf("\nexit status: " HELP_EXIT_STATUS "\n");
}
