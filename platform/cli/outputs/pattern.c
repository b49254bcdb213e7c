/* pattern.c: names of files for several photos are made from one pattern. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "line/report.h"
#include "outputs/pattern.h"

enum { LONGEST_NAME = 4095, LONGEST_WORD = 64 };

bool pattern_is(const char *text)
{
    return strchr(text, '{') != NULL;
}

/* The value of an option as the command line has it; false where it has none, or none that can be
 * part of a name. */
static bool write_value(const struct option *option, const void *settings, char *text, size_t size)
{
    const void *at = (const char *)settings + option->offset;
    const char *word = NULL;
    double number;

    switch (option->kind) {
    case OPTION_CHOICE:
        word = options_word(option, (uint32_t) * (const int *)at);
        break;
    case OPTION_TEXT:
        word = *(const char *const *)at;
        break;
    case OPTION_NUMBER:
    case OPTION_INTEGER:
        number = *(const double *)at;
        if (isnan(number))
            return false;
        if (option->word && number == option->word_value)
            word = option->word;
        else if (option->other_word && number == option->other_value)
            word = option->other_word;
        else
            return snprintf(text, size, "%.9g", number) > 0;
        break;
    case OPTION_FLAG:
    case OPTION_NUMBERS:
    case OPTION_HEADING:
        return false;
    }
    return word && !strchr(word, '/') && (size_t)snprintf(text, size, "%s", word) < size;
}

/* All words that may stand between braces; NULL behind the last. */
static const char *word_at(const void *list, int i)
{
    static const char *const words[] = {"name", "ext", "n"};

    if (i < 3)
        return words[i];
    i -= 3;
    for (const struct option *option = list; option->help; option++)
        if (option->kind != OPTION_HEADING && !option->elsewhere && i-- == 0)
            return option->name + 2;
    return NULL;
}

static int unknown(const char *where, const char *word, const struct command *command)
{
    const char *nearest = options_nearest(word, word_at, options_of(command));

    if (nearest)
        return report_failure(EXIT_WRONG, where,
                              "{%s} is not known; did you mean {%s}? {{ is a brace", word, nearest);
    return report_failure(EXIT_WRONG, where,
                          "{%s} is not known; give {name}, {ext}, {n} or an option such as {blur}; "
                          "{{ is a brace",
                          word);
}

/* Write the value of one word. */
static int write_word(const char *where, const char *word, const struct pattern_values *values,
                      char *text, size_t size)
{
    const char *base = strrchr(values->photo, '/'), *dot;
    char name[LONGEST_WORD + 2];
    const struct option *option;

    base = strcmp(values->photo, "-") == 0 ? "stdin" : base ? base + 1 : values->photo;
    dot = strrchr(base, '.');
    if (strcmp(word, "name") == 0) {
        snprintf(text, size, "%.*s", dot && dot > base ? (int)(dot - base) : (int)strlen(base),
                 base);
        return EXIT_DONE;
    }
    if (strcmp(word, "ext") == 0) {
        snprintf(text, size, "%s", values->ext);
        return EXIT_DONE;
    }
    if (strcmp(word, "n") == 0) {
        snprintf(text, size, "%0*d", snprintf(NULL, 0, "%d", values->count), values->number);
        return EXIT_DONE;
    }
    snprintf(name, sizeof name, "--%s", word);
    option = options_find(values->command, name);
    if (!option)
        return unknown(where, word, values->command);
    if (option->elsewhere || !write_value(option, values->settings, text, size))
        return report_failure(EXIT_WRONG, where,
                              "{%s} has no value that can be part of a name; give %s one, or leave "
                              "it out",
                              word, name);
    return EXIT_DONE;
}

static int expand(const char *where, const char *pattern, const struct pattern_values *values,
                  char name[LONGEST_NAME + 1])
{
    size_t used = 0;
    int status = EXIT_DONE;

    while (*pattern && used < LONGEST_NAME && status == EXIT_DONE) {
        const size_t length = *pattern == '{' && pattern[1] != '{' ? strcspn(pattern, "}") : 0;
        char word[LONGEST_WORD];

        if (!length) {
            name[used++] = *pattern;
            pattern += *pattern == '{' ? 2 : 1;
            continue;
        }
        if (!pattern[length] || length > LONGEST_WORD)
            return report_failure(EXIT_WRONG, where, "'%s' lacks a closing brace; {{ is a brace",
                                  pattern);
        snprintf(word, sizeof word, "%.*s", (int)length - 1, pattern + 1);
        name[used] = '\0';
        status = write_word(where, word, values, name + used, LONGEST_NAME + 1 - used);
        used += strlen(name + used);
        pattern += length + 1;
    }
    name[used] = '\0';
    if (status == EXIT_DONE && used == LONGEST_NAME)
        return report_failure(EXIT_WRONG, where, "the name is too long; give a shorter one");
    return status;
}

int pattern_expand(const char *where, const char *pattern, const struct pattern_values *values,
                   char **expanded)
{
    char name[LONGEST_NAME + 1];
    const int status = expand(where, pattern, values, name);

    *expanded = status == EXIT_DONE ? strdup(name) : NULL;
    if (status == EXIT_DONE && !*expanded)
        return report_failure(EXIT_FAILED, where, "not enough memory");
    return status;
}
