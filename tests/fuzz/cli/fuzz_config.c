/* fuzz_config.c: configuration files over a table with every kind of option: values that are taken
 * are in their ranges, and of one group one alone. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "line/list.h"
#include "line/report.h"
#include "settings/config.h"

struct values {
    bool flag;
    double number, other[4], whole;
    const char *text;
    int choice;
};

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
     .name = "--other",
     .argument = "A,B,C,D",
     .group = "g",
     .offset = offsetof(struct values, other),
     .least = 0,
     .greatest = 99,
     .count = 4,
     .help = "other"},
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
static const struct command command = {.name = "fuzz", .usage = "", .options = options};

const struct command *const commands[] = {&command, NULL};

const struct command *commands_find(const char *name)
{
    return strcmp(name, command.name) == 0 ? &command : NULL;
}

static bool in(double value, double least, double most)
{
    return isnan(value) || (value >= least && value <= most);
}

static void check(const uint8_t *data, size_t size, const char *section)
{
    struct values v = {false, 0.5, {NAN, NAN, NAN, NAN}, NAN, NULL, 0};
    bool found;
    const int status = config_read(&command, "file", (const char *)data, size, section, &v, &found);

    if (status != OPTIONS_PARSED && status != EXIT_FAILED)
        abort();
    if (status != OPTIONS_PARSED)
        return;
    if (!(in(v.number, -1, 1) || v.number == INFINITY) || !in(v.whole, 0, 9) || v.choice < 0 ||
        v.choice > 2 || (v.text && !*v.text))
        abort();
    for (int i = 0; i < 4; i++)
        if (!in(v.other[i], 0, 99))
            abort();
    if (!found && (v.number != 0.5 || v.flag || v.text || v.choice))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check(data, size, "fuzz");
    check(data, size, "preset mine");
    return 0;
}
