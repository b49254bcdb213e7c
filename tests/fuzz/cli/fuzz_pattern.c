/* fuzz_pattern.c: patterns of names: one that is taken has no value missing and stays in its
 * folder, whatever the photo and the options are called. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "line/report.h"
#include "outputs/pattern.h"

enum { LONGEST = 4095 };

struct values {
    double number;
    const char *text;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "heading"},
    {OPTION(OPTION_NUMBER, "--number", "N", struct values, number), .greatest = 9, .word = "off",
     .word_value = INFINITY, .help = "number"},
    {OPTION(OPTION_TEXT, "--text", "TEXT", struct values, text), .help = "text"},
    {.help = NULL},
};

static int count(const char *text, char of)
{
    int n = 0;

    for (; *text; text++)
        n += *text == of;
    return n;
}

/* The first line of the data is the photo's name, the rest the pattern. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct command command = {.name = "fuzz", .table = options};
    struct values values = {size % 3 ? 1.5 : (double)NAN, "text"};
    char *text = malloc(size + 1), *pattern, *name = NULL;
    struct pattern_values given = {&command, &values, text, "jpg", (int)(size % 7) + 1, 7};

    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    pattern = strchr(text, '\n');
    if (pattern) {
        *pattern++ = '\0';
        const int status = pattern_expand("-o", pattern, &given, &name);

        if ((status == EXIT_DONE) != (name != NULL))
            abort();
        if (name && (strlen(name) > LONGEST || count(name, '/') != count(pattern, '/')))
            abort();
        if (name && !pattern_is(pattern) && strcmp(name, pattern) != 0)
            abort();
    }
    free(name);
    free(text);
    return 0;
}
