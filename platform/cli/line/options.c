#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "line/options.h"
#include "line/report.h"
#include "line/settings.h"

enum { HELP_COLUMN = 26, HELP_WIDTH = 80, LONGEST_WORD = 63, RANGE_LENGTH = 120 };

/* Edits (insert, delete, replace, swap neighbours) from one word to another. */
static int edits(const char *a, const char *b)
{
    int rows[3][LONGEST_WORD + 2];
    const int m = (int)strlen(a), n = (int)strlen(b);

    if (m > LONGEST_WORD || n > LONGEST_WORD)
        return LONGEST_WORD;
    for (int j = 0; j <= n; j++)
        rows[0][j] = j;
    for (int i = 1; i <= m; i++) {
        int *row = rows[i % 3], *last = rows[(i + 2) % 3], *before = rows[(i + 1) % 3];

        row[0] = i;
        for (int j = 1; j <= n; j++) {
            int least = last[j - 1] + (a[i - 1] != b[j - 1]);
            if (last[j] + 1 < least)
                least = last[j] + 1;
            if (row[j - 1] + 1 < least)
                least = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < least)
                least = before[j - 2] + 1;
            row[j] = least;
        }
    }
    return rows[m % 3][n];
}

const char *options_nearest(const char *text, const char *(*word)(const void *list, int i),
                            const void *list)
{
    const int letters = (int)strlen(text) - (int)strspn(text, "-");
    const char *nearest = NULL;
    int least = letters / 3 + 1; /* more edits than that are another word */

    for (int i = 0; word(list, i); i++) {
        int distance = edits(text, word(list, i));
        if (letters >= 2 && strncmp(text, word(list, i), strlen(text)) == 0)
            distance = 0; /* the beginning of a word */
        if (distance < least || (distance == least && !nearest)) {
            least = distance;
            nearest = word(list, i);
        }
    }
    return nearest;
}

static const char *option_name(const void *list, int i)
{
    const struct option *option = list;

    for (; option->help; option++)
        if (option->kind != OPTION_HEADING && i-- == 0)
            return option->name;
    return i == 0 ? "--help" : NULL;
}

static const char *choice_word(const void *list, int i)
{
    return ((const struct option *)list)->choice((uint32_t)i);
}

/* "from 0 to 1", "above 0", ..., and the word that may stand for a number. */
static const char *range_text(const struct option *option, char text[RANGE_LENGTH])
{
    const char *what = option->kind == OPTION_INTEGER   ? "a whole number"
                       : option->kind == OPTION_NUMBERS ? option->argument
                                                        : "a number";
    int n = snprintf(text, RANGE_LENGTH, "%s", what);

    if (option->kind == OPTION_NUMBERS && option->least == -INFINITY)
        return text;
    if (option->above)
        n += snprintf(text + n, (size_t)(RANGE_LENGTH - n), " above %.9g", option->least);
    if (option->above && isfinite(option->greatest))
        n += snprintf(text + n, (size_t)(RANGE_LENGTH - n), ", at most %.9g", option->greatest);
    if (!option->above && isfinite(option->greatest))
        n += snprintf(text + n, (size_t)(RANGE_LENGTH - n), " from %.9g to %.9g", option->least,
                      option->greatest);
    else if (!option->above)
        n += snprintf(text + n, (size_t)(RANGE_LENGTH - n), " of at least %.9g", option->least);
    if (option->word)
        snprintf(text + n, (size_t)(RANGE_LENGTH - n), ", or '%s'", option->word);
    return text;
}

static bool in_range(const struct option *option, double value)
{
    return (option->above ? value > option->least : value >= option->least) &&
           value <= option->greatest;
}

/* A decimal number at *text, which moves behind it. No hexadecimal, no blanks. */
static bool read_number(const char **text, double *value)
{
    const size_t length = strspn(*text, "+-.0123456789eE");
    char *end;

    if (strncmp(*text, "inf", 3) == 0) {
        *value = INFINITY;
        *text += 3;
        return true;
    }
    *value = strtod(*text, &end);
    if (end == *text || end > *text + length)
        return false;
    *text = end;
    return true;
}

static int wrong_number(const struct option *option, const char *name, const char *text)
{
    char range[RANGE_LENGTH];

    return report_failure(EXIT_WRONG, name, "'%s' cannot be used; give %s", text,
                          range_text(option, range));
}

static int parse_numbers(const struct option *option, const char *name, const char *text,
                         double *values)
{
    const int count = option->kind == OPTION_NUMBERS ? option->count : 1;
    const char *at = text;

    if (option->word && strcmp(text, option->word) == 0) {
        *values = option->word_value;
        return OPTIONS_PARSED;
    }
    for (int i = 0; i < count; i++) {
        double value;

        if (i > 0 && !(*at == ',' || (*at == 'x' && count == 2)))
            return wrong_number(option, name, text);
        at += i > 0;
        if (!read_number(&at, &value) || !in_range(option, value) ||
            (option->kind != OPTION_NUMBER && value != floor(value)))
            return wrong_number(option, name, text);
        values[i] = value;
    }
    return *at == '\0' ? OPTIONS_PARSED : wrong_number(option, name, text);
}

static int parse_choice(const struct option *option, const char *name, const char *text,
                        int *chosen)
{
    char words[256] = "";
    const char *nearest;

    for (uint32_t i = 0; option->choice(i); i++) {
        if (strcmp(option->choice(i), text) == 0) {
            *chosen = (int)i;
            return OPTIONS_PARSED;
        }
        snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s", i > 0 ? ", " : "",
                 option->choice(i));
    }
    nearest = options_nearest(text, choice_word, option);
    if (nearest)
        return report_failure(EXIT_WRONG, name, "'%s' is not one of %s; did you mean '%s'?", text,
                              words, nearest);
    return report_failure(EXIT_WRONG, name, "'%s' cannot be used; give one of %s", text, words);
}

int options_set(const struct option *option, const char *name, const char *text, void *settings)
{
    void *value = (char *)settings + option->offset;

    switch (option->kind) {
    case OPTION_NUMBER:
    case OPTION_INTEGER:
    case OPTION_NUMBERS:
        return parse_numbers(option, name, text, value);
    case OPTION_CHOICE:
        return parse_choice(option, name, text, value);
    case OPTION_TEXT:
        if (*text == '\0')
            return report_failure(EXIT_WRONG, name, "is empty; give %s", option->argument);
        *(const char **)value = text;
        return OPTIONS_PARSED;
    case OPTION_FLAG:
    case OPTION_HEADING:
        break;
    }
    *(bool *)value = true;
    return OPTIONS_PARSED;
}

const struct option *options_at(const struct command *command, const char *argument,
                                const char **value)
{
    const size_t length = strcspn(argument, "=");

    *value = NULL;
    for (const struct option *option = command->options; option->help; option++) {
        if (option->kind == OPTION_HEADING)
            continue;
        if (option->letter && argument[0] == '-' && argument[1] == option->letter) {
            *value = argument[2] ? argument + 2 : NULL;
            return option;
        }
        if (strlen(option->name) == length && strncmp(argument, option->name, length) == 0) {
            *value = argument[length] ? argument + length + 1 : NULL;
            return option;
        }
    }
    return NULL;
}

const struct option *options_find(const struct command *command, const char *name)
{
    for (const struct option *option = command->options; option->help; option++)
        if (option->kind != OPTION_HEADING && strcmp(option->name, name) == 0)
            return option;
    return NULL;
}

const char *options_nearest_name(const struct command *command, const char *name)
{
    return options_nearest(name, option_name, command->options);
}

/* Files of settings come before all else on the command line, which overrules them. */
static int load_settings(const struct command *command, int argc, char **argv, void *settings)
{
    const struct option *row = options_find(command, SETTINGS_NAME);
    const size_t length = strlen(SETTINGS_NAME);

    for (int i = 1; row && i < argc && strcmp(argv[i], "--") != 0; i++) {
        const char *file = NULL;
        int status;

        if (strcmp(argv[i], SETTINGS_NAME) == 0 && i + 1 < argc)
            file = argv[i + 1];
        else if (strncmp(argv[i], SETTINGS_NAME "=", length + 1) == 0)
            file = argv[i] + length + 1;
        if (!file)
            continue;
        status = settings_load(command, file, settings);
        if (status != OPTIONS_PARSED)
            return status;
    }
    return OPTIONS_PARSED;
}

static int unknown_option(const struct command *command, const char *argument)
{
    char name[LONGEST_WORD + 1];
    const char *nearest;

    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    nearest = options_nearest_name(command, name);
    if (nearest)
        return report_failure(EXIT_WRONG, name, "unknown option; did you mean %s?", nearest);
    return report_failure(EXIT_WRONG, name,
                          "unknown option; 'refocus %s --help' lists "
                          "them",
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
            return report_failure(EXIT_WRONG, option->name,
                                  "takes no value; leave "
                                  "'=%s' out",
                                  value);
        return options_set(option, option->name, "", settings);
    }
    if (!value && *i + 1 < argc && strncmp(argv[*i + 1], "--", 2) != 0)
        value = argv[++*i];
    if (!value)
        return report_failure(EXIT_WRONG, option->name, "has no value; give %s", option->argument);
    return options_set(option, option->name, value, settings);
}

int options_parse(const struct command *command, int argc, char **argv, void *settings,
                  const char **files)
{
    int count = 0, loaded = load_settings(command, argc, argv, settings);
    bool names_only = false;

    if (loaded != OPTIONS_PARSED)
        return loaded;

    for (int i = 1; i < argc; i++) {
        if (!names_only && argv[i][0] == '-' && argv[i][1] != '\0') {
            if (strcmp(argv[i], "--") == 0) {
                names_only = true;
                continue;
            }
            if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
                options_print_help(command);
                return report_end_output();
            }
            const int status = parse_option(command, argc, argv, &i, settings);
            if (status != OPTIONS_PARSED)
                return status;
            continue;
        }
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
    char text[1024], range[RANGE_LENGTH];
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
        snprintf(text, sizeof text, "%s (%s)", option->help, range_text(option, range));
    else
        snprintf(text, sizeof text, "%s", option->help);
    if (option->kind == OPTION_CHOICE && !option->summary)
        for (uint32_t i = 0; option->choice(i); i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i == 0 ? ": " : ", ",
                     option->choice(i));
    print_wrapped(text, HELP_COLUMN, HELP_COLUMN);
    if (option->kind == OPTION_CHOICE && option->summary)
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
