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
    {OPTION(OPTION_FLAG, "--flag", NULL, struct values, flag), .help = "flag"},
    {OPTION(OPTION_NUMBER, "--number", "N", struct values, number), .group = "g", .least = -1,
     .greatest = 1, .word = "off", .word_value = INFINITY, .help = "number"},
    {OPTION(OPTION_NUMBERS, "--several", "A,B,C,D", struct values, several), .group = "g",
     .least = 0, .greatest = 99, .count = 4, .decimals = true, .help = "several"},
    {OPTION(OPTION_INTEGER, "--whole", "N", struct values, whole), .least = 0, .greatest = 9,
     .help = "whole"},
    {OPTION(OPTION_TEXT, "--text", "TEXT", struct values, text), .help = "text"},
    {OPTION(OPTION_CHOICE, "--choice", "WORD", struct values, choice), .choice = word,
     .help = "choice"},
    {OPTION(OPTION_TEXT, "--output", "FILE", struct values, text), .help = "output",
     .elsewhere = true},
    {.help = NULL},
};
const struct command fuzz_command = {.name = "fuzz", .usage = "", .table = options};

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
