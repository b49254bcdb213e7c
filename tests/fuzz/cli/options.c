/* options.c: a command with an option of every kind, and the ranges of its values. */
#include "options.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static const char *word(uint32_t index)
{
    static const char *const words[] = {"one", "two", "three"};

    return index < 3 ? words[index] : NULL;
}

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "heading"},
    {.kind = OPTION_FLAG,
     .name = "--flag",
     .offset = offsetof(struct values, flag),
     .help = "flag"},
    {.kind = OPTION_NUMBER,
     .name = "--number",
     .argument = "N",
     .group = "g",
     .offset = offsetof(struct values, number),
     .least = -1,
     .greatest = 1,
     .word = "off",
     .word_value = INFINITY,
     .help = "number"},
    {.kind = OPTION_NUMBERS,
     .name = "--several",
     .argument = "A,B,C,D",
     .group = "g",
     .offset = offsetof(struct values, several),
     .least = 0,
     .greatest = 99,
     .count = 4,
     .decimals = true,
     .help = "several"},
    {.kind = OPTION_INTEGER,
     .name = "--whole",
     .argument = "N",
     .offset = offsetof(struct values, whole),
     .least = 0,
     .greatest = 9,
     .help = "whole"},
    {.kind = OPTION_TEXT,
     .name = "--text",
     .argument = "TEXT",
     .offset = offsetof(struct values, text),
     .help = "text"},
    {.kind = OPTION_CHOICE,
     .name = "--choice",
     .argument = "WORD",
     .offset = offsetof(struct values, choice),
     .choice = word,
     .help = "choice"},
    {.kind = OPTION_TEXT,
     .name = "--output",
     .argument = "FILE",
     .offset = offsetof(struct values, text),
     .help = "output",
     .elsewhere = true},
    {.help = NULL},
};
const struct command fuzz_command = {.name = "fuzz", .usage = "", .options = options};

static bool in(double value, double least, double most)
{
    return isnan(value) || (value >= least && value <= most);
}

void fuzz_check_values(const struct values *v)
{
    if (!(in(v->number, -1, 1) || v->number == INFINITY) || !in(v->whole, 0, 9) || v->choice < 0 ||
        v->choice > 2 || (v->text && !*v->text))
        abort();
    for (int i = 0; i < 4; i++)
        if (!in(v->several[i], 0, 99))
            abort();
}
