/* fuzz_settings.c: files of settings over a table with every kind of option: values that are
 * taken are in their ranges. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "outputs/outputs.h"
#include "line/report.h"
#include "settings/settings.h"

struct values {
    bool flag;
    double number, whole, several[4];
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
     .offset = offsetof(struct values, number),
     .least = -1,
     .greatest = 1,
     .word = "off",
     .word_value = INFINITY,
     .help = "number"},
    {.kind = OPTION_INTEGER,
     .name = "--whole",
     .argument = "N",
     .offset = offsetof(struct values, whole),
     .least = 0,
     .greatest = 9,
     .help = "whole"},
    {.kind = OPTION_NUMBERS,
     .name = "--several",
     .argument = "A,B,C,D",
     .offset = offsetof(struct values, several),
     .least = 0,
     .greatest = 99,
     .count = 4,
     .help = "several"},
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

int output_check(const char *path, unsigned kinds, const char *const *others,
                 const char *const *inputs, int input_count)
{
    (void)path;
    (void)kinds;
    (void)others;
    (void)inputs;
    (void)input_count;
    return EXIT_DONE;
}

static bool in(double value, double least, double most)
{
    return isnan(value) || (value >= least && value <= most);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct values v = {false, NAN, NAN, {NAN, NAN, NAN, NAN}, NULL, 0};
    const int status = settings_read(&command, "file", (const char *)data, size, &v);

    if (status != OPTIONS_PARSED && status != EXIT_FAILED)
        abort();
    if (status != OPTIONS_PARSED)
        return 0;
    if (!(in(v.number, -1, 1) || v.number == INFINITY) || !in(v.whole, 0, 9) || v.choice < 0 ||
        v.choice > 2 || (v.text && !*v.text))
        abort();
    for (int i = 0; i < 4; i++)
        if (!in(v.several[i], 0, 99))
            abort();
    return 0;
}
