/* man.c: manual pages, in the macros of man(7), from the tables of options. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <refocus/version.h>
#include "line/help.h"
#include "line/man.h"

/* Print text that holds no requests: every character stands for itself, and "-" is the one that
 * options are typed with. */
static void print_text(const char *text)
{
    bool begins = true;

    for (; *text; text++) {
        if (begins && (*text == '.' || *text == '\''))
            fputs("\\&", stdout);
        begins = *text == '\n';
        switch (*text) {
        case '\\':
            fputs("\\e", stdout);
            break;
        case '-':
            fputs("\\-", stdout);
            break;
        case '^':
            fputs("\\(ha", stdout);
            break;
        case '~':
            fputs("\\(ti", stdout);
            break;
        case '\n':
            fputs("\n.PP\n", stdout);
            break;
        default:
            putchar(*text);
        }
    }
}

static void print_line(const char *text)
{
    print_text(text);
    putchar('\n');
}

static void print_bold(const char *text)
{
    fputs("\\fB", stdout);
    print_text(text);
    fputs("\\fR", stdout);
}

void man_print_beginning(const char *name, const char *summary)
{
    fputs(".TH ", stdout);
    for (const char *c = name; *c; c++)
        putchar(toupper((unsigned char)*c));
    printf(" 1 \"\" \"librefocus %s\" \"User Commands\"\n.SH NAME\n", refocus_version());
    print_text(name);
    fputs(" \\- ", stdout);
    print_line(summary);
}

void man_print_synopsis(const char *name, const char *usage)
{
    puts(".SH SYNOPSIS");
    print_bold(name);
    putchar(' ');
    print_line(usage);
}

void man_print_section(const char *title)
{
    printf(".SH %s\n", title);
}

void man_print_item(const char *word, const char *usage, const char *text)
{
    puts(".TP");
    print_bold(word);
    fputs(*usage ? " " : "", stdout);
    print_line(usage);
    print_line(text);
}

/* The words of a choice, each with its line. */
static void print_words(const struct option *option)
{
    puts(".RS");
    for (uint32_t i = 0; options_word(option, i); i++) {
        puts(".TP");
        print_bold(options_word(option, i));
        putchar('\n');
        print_line(options_summary(option, i));
    }
    puts(".RE");
}

static void print_option(const struct option *option)
{
    char text[HELP_LENGTH];

    if (option->kind == OPTION_HEADING) {
        fputs(".SS ", stdout);
        print_line(option->help);
        return;
    }
    puts(".TP");
    if (option->letter) {
        printf("\\fB\\-%c\\fR, ", option->letter);
    }
    print_bold(option->name);
    if (option->argument) {
        fputs(" \\fI", stdout);
        print_text(option->argument);
        fputs("\\fR", stdout);
    }
    putchar('\n');
    help_text(option, text, sizeof text);
    print_line(text);
    if (options_summary(option, 0))
        print_words(option);
}

void man_print_end(const struct command *const *commands, const struct command *self)
{
    puts(".SH EXIT STATUS\n" HELP_EXIT_STATUS "\n.SH SEE ALSO");
    fputs(self ? "\\fBrefocus\\fR(1)" : "", stdout);
    for (int i = 0, shown = self != NULL; commands[i]; i++)
        if (commands[i] != self)
            printf("%s\\fBrefocus\\-%s\\fR(1)", shown++ ? ",\n" : "", commands[i]->name);
    putchar('\n');
}

void man_print_command(const struct command *command, const struct command *const *commands)
{
    char name[64];

    snprintf(name, sizeof name, "refocus-%s", command->name);
    man_print_beginning(name, command->summary);
    name[strlen("refocus")] = ' ';
    man_print_synopsis(name, command->usage);
    if (command->notes) {
        man_print_section("DESCRIPTION");
        print_line(command->notes);
    }
    man_print_section("OPTIONS");
    for (const struct option *option = options_of(command); option->help; option++)
        print_option(option);
    man_print_item("--help", "", "the options that most need; also -h");
    man_print_item("--help-all", "", "all of them");
    man_print_end(commands, command);
}
