/* option.c: an option is found by its name, or one that is like it, and given its value. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "line/option.h"
#include "line/report.h"

enum { LONGEST_WORD = 63 };

/* A table with the rows of its groups in their places. */
struct flat {
    const struct option *table;
    struct flat *next;
    struct option rows[];
};

/* Copies rows, which lie at `base` in the settings, and those of groups, to `to`; where that is
 * NULL they are only counted. */
static size_t copy_rows(struct option *to, const struct option *from, size_t base)
{
    size_t count = 0;

    for (; from->help; from++) {
        if (from->rows) {
            count += copy_rows(to ? to + count : NULL, from->rows, base + from->offset);
            continue;
        }
        if (to) {
            to[count] = *from;
            to[count].offset += base;
            to[count].of_offset += base;
        }
        count++;
    }
    return count;
}

const struct option *options_of(const struct command *command)
{
    static struct flat *first;
    struct flat *flat = first;

    while (flat && flat->table != command->table)
        flat = flat->next;
    if (flat)
        return flat->rows;
    flat = calloc(1, sizeof *flat + (copy_rows(NULL, command->table, 0) + 1) * sizeof *flat->rows);
    if (!flat) {
        report_failure(EXIT_FAILED, command->name, "not enough memory for its options");
        exit(EXIT_FAILED);
    }
    copy_rows(flat->rows, command->table, 0);
    flat->table = command->table;
    flat->next = first;
    first = flat;
    return flat->rows;
}

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
    int least = (letters + 2) / 3; /* more edits than that are another word */

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

const char *options_word(const struct option *option, uint32_t index)
{
    return option->words    ? option->words[index].name
           : option->choice ? option->choice(index)
                            : NULL;
}

const char *options_summary(const struct option *option, uint32_t index)
{
    return option->summary ? option->summary(index)
           : option->words ? option->words[index].summary
                           : NULL;
}

static const char *choice_word(const void *list, int i)
{
    return options_word(list, (uint32_t)i);
}

/* "from 0 to 1", "above 0", ..., and the word that may stand for a number. */
const char *options_range(const struct option *option, char text[OPTION_RANGE_LENGTH])
{
    const char *what = option->kind == OPTION_INTEGER   ? "a whole number"
                       : option->kind == OPTION_NUMBERS ? option->argument
                                                        : "a number";
    const int digits = option->kind == OPTION_INTEGER ? 17 : 9; /* all of a whole number's */
    int n = snprintf(text, OPTION_RANGE_LENGTH, "%s", what);

    if (option->kind == OPTION_NUMBERS && option->least == -INFINITY)
        return text;
    if (option->above)
        n += snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), " above %.*g", digits,
                      option->least);
    if (option->above && isfinite(option->greatest))
        n += snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), ", at most %.*g", digits,
                      option->greatest);
    if (!option->above && isfinite(option->greatest))
        n += snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), " from %.*g to %.*g", digits,
                      option->least, digits, option->greatest);
    else if (!option->above)
        n += snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), " of at least %.*g", digits,
                      option->least);
    if (option->word)
        n += snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), ", or '%s'", option->word);
    if (option->other_word)
        snprintf(text + n, (size_t)(OPTION_RANGE_LENGTH - n), ", or '%s'", option->other_word);
    return text;
}

static bool in_range(const struct option *option, double value)
{
    return (option->above ? value > option->least : value >= option->least) &&
           value <= option->greatest;
}

static bool is_whole(const struct option *option)
{
    return option->kind == OPTION_INTEGER || (option->kind == OPTION_NUMBERS && !option->decimals);
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

/* Divides a number by one behind a slash at *text, if there is one; false: it is no divisor. */
static bool read_divisor(const char **text, double *value)
{
    double divisor = 1;

    if (**text != '/')
        return true;
    ++*text;
    if (!read_number(text, &divisor) || !(divisor > 0))
        return false;
    *value /= divisor;
    return true;
}

static int wrong_number(const struct option *option, const char *name, const char *text)
{
    char range[OPTION_RANGE_LENGTH];

    return report_failure(EXIT_WRONG, name, "'%s' cannot be used; give %s", text,
                          options_range(option, range));
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
    if (option->other_word && strcmp(text, option->other_word) == 0) {
        *values = option->other_value;
        return OPTIONS_PARSED;
    }
    for (int i = 0; i < count; i++) {
        double value;

        if (i > 0 && !(*at == ',' || (*at == 'x' && count == 2)))
            return wrong_number(option, name, text);
        at += i > 0;
        if (!read_number(&at, &value) || (option->fraction && !read_divisor(&at, &value)) ||
            !in_range(option, value) || (is_whole(option) && value != floor(value)))
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

    for (uint32_t i = 0; options_word(option, i); i++) {
        if (strcmp(options_word(option, i), text) == 0) {
            *chosen = (int)i;
            return OPTIONS_PARSED;
        }
        snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s", i > 0 ? ", " : "",
                 options_word(option, i));
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
    for (const struct option *option = options_of(command); option->help; option++) {
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
    for (const struct option *option = options_of(command); option->help; option++)
        if (option->kind != OPTION_HEADING && strcmp(option->name, name) == 0)
            return option;
    return NULL;
}

const char *options_nearest_name(const struct command *command, const char *name)
{
    return options_nearest(name, option_name, options_of(command));
}
