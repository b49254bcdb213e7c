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

static void print_option(const struct option *option)
{
    char text[1024], range[OPTION_RANGE_LENGTH];
    int n;

    if (option->kind == OPTION_HEADING) {
        printf("\n%s\n", option->help);
        return;
    }
    n = option->letter ? printf("  -%c, %s", option->letter, option->name)
                       : printf("  %s", option->name);
    if (option->argument)
        n += printf(" %s", option->argument);
    if (n > HELP_COLUMN - 2) {
        putchar('\n');
        n = 0;
    }
    printf("%*s", HELP_COLUMN - n, "");
    if (option->kind == OPTION_NUMBER || option->kind == OPTION_INTEGER)
        snprintf(text, sizeof text, "%s (%s)", option->help, options_range(option, range));
    else
        snprintf(text, sizeof text, "%s", option->help);
    if (option->kind == OPTION_CHOICE && !option->summary)
        for (uint32_t i = 0; option->choice(i); i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i == 0 ? ": " : ", ",
                     option->choice(i));
    print_wrapped(text, HELP_COLUMN, HELP_COLUMN);
    if (option->summary)
        for (uint32_t i = 0; option->choice(i); i++) {
            printf("%*s%-13s", HELP_COLUMN + 2, "", option->choice(i));
            print_wrapped(option->summary(i), HELP_COLUMN + 15, HELP_COLUMN + 15);
        }
}

void options_print_help(const struct command *command)
{
    printf("usage: refocus %s %s\n\n", command->name, command->usage);
    print_wrapped(command->summary, 0, 0);
    for (const struct option *option = command->options; option->help; option++)
        print_option(option);
    printf("  -h, --help%*sthis text\n", HELP_COLUMN - 12, "");
    if (command->notes) {
        putchar('\n');
        print_wrapped(command->notes, 0, 0);
    }
    printf("\nexit status: 0 done, 1 it could not be done, 2 the command line is "
           "wrong\n");
}
