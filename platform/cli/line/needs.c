/* needs.c: which options a command line gives, and options that would change nothing. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "line/needs.h"
#include "line/report.h"

enum { TEXT_LENGTH = 256 };

/* The row of the next option in argv from *i on, which moves behind it and its value;
 * NULL: there is none. */
static const struct option *next_given(const struct command *command, int argc, char **argv, int *i)
{
    while (*i < argc && strcmp(argv[*i], "--") != 0) {
        const char *argument = argv[(*i)++], *value;
        const struct option *option =
            argument[0] == '-' && argument[1] ? options_at(command, argument, &value) : NULL;

        if (!option)
            continue;
        *i += option->kind != OPTION_FLAG && !value;
        return option;
    }
    return NULL;
}

bool options_given(const struct command *command, int argc, char **argv, const char *name)
{
    const struct option *option;
    int i = 1;

    while ((option = next_given(command, argc, argv, &i)) != NULL)
        if (strcmp(option->name, name) == 0)
            return true;
    return false;
}

static bool is_listed(const char *name, const char *const *names)
{
    for (int i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

static int refuse(const struct command *command, int argc, char **argv, const char *const *names,
                  bool listed, const char *why)
{
    const struct option *option;
    int i = 1;

    while ((option = next_given(command, argc, argv, &i)) != NULL)
        if (is_listed(option->name, names) == listed)
            return report_failure(EXIT_WRONG, option->name, "%s", why);
    return EXIT_DONE;
}

int options_refuse(const struct command *command, int argc, char **argv, const char *const *names,
                   const char *why)
{
    return refuse(command, argc, argv, names, true, why);
}

int options_refuse_beside(const struct command *command, int argc, char **argv,
                          const char *const *names, const char *why)
{
    return refuse(command, argc, argv, names, false, why);
}

/* Whether an option that others need has a value, wherever it comes from. */
static bool has_value(const struct option *option, const void *settings)
{
    const void *at = (const char *)settings + option->offset;

    switch (option->kind) {
    case OPTION_FLAG:
        return *(const bool *)at;
    case OPTION_TEXT:
        return *(const char *const *)at != NULL;
    case OPTION_CHOICE:
        return *(const int *)at > 0; /* the first word stands for none */
    case OPTION_NUMBER:
    case OPTION_INTEGER:
    case OPTION_NUMBERS:
        return !isnan(*(const double *)at);
    case OPTION_HEADING:
        break;
    }
    return false;
}

static bool is_of(const struct option *option, uint32_t word)
{
    return option->of_takes ? option->of_takes(word) : (option->of_words >> word & 1) != 0;
}

/* "search, blur" */
static void list_words(const struct option *option, char text[TEXT_LENGTH])
{
    int n = 0;

    text[0] = '\0';
    for (uint32_t i = 0; option->of_word(i) && n < TEXT_LENGTH; i++)
        if (is_of(option, i))
            n += snprintf(text + n, (size_t)(TEXT_LENGTH - n), "%s%s", n > 0 ? ", " : "",
                          option->of_word(i));
}

static int not_of(const struct option *option, int word)
{
    char words[TEXT_LENGTH];

    list_words(option, words);
    return report_failure(EXIT_WRONG, option->name,
                          "it changes nothing with %s %s; give %s%s%s, or leave it out", option->of,
                          option->of_word((uint32_t)word), words, option->needs ? ", or " : "",
                          option->needs ? option->needs : "");
}

/* Whether one of the options that it needs has a value; false when it needs none. */
static bool is_met(const struct command *command, const char *needs, const void *settings)
{
    char name[TEXT_LENGTH];

    while (needs && *needs) {
        const size_t length = strcspn(needs, ",");
        const struct option *other;

        snprintf(name, sizeof name, "%.*s", (int)length, needs);
        other = options_find(command, name);
        if (other && has_value(other, settings))
            return true;
        needs += length + (needs[length] == ',');
    }
    return false;
}

static int check(const struct command *command, const struct option *option, const void *settings)
{
    const bool met = is_met(command, option->needs, settings);
    const int word = option->of ? *(const int *)((const char *)settings + option->of_offset) : -1;

    if (option->of)
        return word < 0 || is_of(option, (uint32_t)word) || met ? OPTIONS_PARSED
                                                                : not_of(option, word);
    if (!option->needs || met)
        return OPTIONS_PARSED;
    return report_failure(EXIT_WRONG, option->name, "it goes with %.*s; give that too",
                          (int)strcspn(option->needs, ","), option->needs);
}

int options_check_needs(const struct command *command, int argc, char **argv, const void *settings)
{
    const struct option *option;
    int i = 1, status = OPTIONS_PARSED;

    while (status == OPTIONS_PARSED && (option = next_given(command, argc, argv, &i)) != NULL)
        status = check(command, option, settings);
    return status;
}
