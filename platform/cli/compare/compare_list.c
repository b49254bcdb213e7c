/* compare_list.c: the list of methods to compare, each with options of its own, is parsed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "compare/compare_list.h"
#include "shot/shot_options.h"

enum { WORDS_MOST = 32 }; /* options for one method */

static const struct option options[] = {
    GROUP(ray_options, struct variant, settings),
    QUALITY_OPTION(struct variant, settings.quality, "standard", NULL),
    GROUP(rendering_options, struct variant, settings),
    GROUP(paper_options, struct variant, settings),
    {.help = NULL},
};

/* The command by which an entry's options are parsed. */
static const struct command entry = {.name = "compare", .usage = "[options]", .table = options};

static const char *method_word(const void *list, int i)
{
    (void)list;
    return refocus_method_name((uint32_t)i);
}

static int find_method(const char *name, int *method)
{
    const char *nearest;

    for (*method = 0; *method < REFOCUS_METHOD_COUNT; ++*method)
        if (strcmp(refocus_method_name((uint32_t)*method), name) == 0)
            return EXIT_DONE;
    nearest = options_nearest(name, method_word, NULL);
    return report_failure(EXIT_WRONG, "--methods", "'%s' is no method%s%s%s", name,
                          nearest ? "; did you mean '" : "; 'refocus render --help-all' lists them",
                          nearest ? nearest : "", nearest ? "'?" : "");
}

static bool knows(const struct command *command, const char *word)
{
    const char *value;

    return options_at(command, word, &value) != NULL;
}

/* An option that all methods share is none of a single one. */
static int check_own(char *word)
{
    if (knows(&entry, word) || !knows(&compare_command, word))
        return EXIT_DONE;
    word[strcspn(word, "=")] = '\0';
    return report_failure(EXIT_WRONG, word,
                          "unknown option within --methods; it is the same for all of them, so "
                          "give it beside --methods");
}

/* "search:rays=64:mirror" with its colons cut: to "--rays=64", "--mirror" in *words. */
static int parse_entry(struct variant *variant, char *text, char **words)
{
    char *argv[WORDS_MOST + 2] = {(char *)"compare"};
    const char *files[1];
    char *name = text, *next = strchr(text, ':');
    int argc = 1, status;

    while (next) {
        const char *option = next + 1;

        *next = '\0';
        next = strchr(next + 1, ':');
        if (argc > WORDS_MOST)
            return report_failure(EXIT_WRONG, "--methods",
                                  "'%s' has too many options; give at most %d", name, WORDS_MOST);
        argv[argc++] = *words;
        *words += 1 + sprintf(*words, "--%.*s", (int)strcspn(option, ":"), option);
        status = check_own(argv[argc - 1]);
        if (status != EXIT_DONE)
            return status;
    }
    status = find_method(name, &variant->settings.method);
    if (status != EXIT_DONE)
        return status;
    status = options_parse(&entry, argc, argv, variant, files);
    if (status != OPTIONS_PARSED)
        return status;
    return engine_begin(&variant->engine, &variant->settings);
}

static bool is_listed(const struct variants *variants, const char *label)
{
    for (int i = 0; i < variants->count; i++)
        if (strcmp(variants->variant[i].label, label) == 0)
            return true;
    return false;
}

/* Splits list, which is written to, and copies each entry to *words twice: as it is,
 * and cut. */
static int add_all(struct variants *variants, char *list, char **words,
                   const struct engine_settings *common)
{
    for (char *text = strtok(list, ","); text; text = strtok(NULL, ",")) {
        struct variant *variant = &variants->variant[variants->count];
        char *copy = *words;
        int status;

        if (is_listed(variants, text))
            continue;
        if (variants->count == VARIANTS_MOST)
            return report_failure(EXIT_WRONG, "--methods", "there are too many; give at most %d",
                                  VARIANTS_MOST);
        variants->count++;
        variant->label = text;
        variant->settings = *common;
        *words += 1 + sprintf(copy, "%s", text);
        status = parse_entry(variant, copy, words);
        if (status != EXIT_DONE)
            return status;
    }
    if (variants->count == 0)
        return report_failure(EXIT_WRONG, "--methods", "no method is named; give one or more");
    return EXIT_DONE;
}

int variants_begin(struct variants *variants, const char *list,
                   const struct engine_settings *common)
{
    const bool disc = !common->aperture || strcmp(common->aperture, "disc") == 0;
    char all[16 * REFOCUS_METHOD_COUNT] = "", *words;
    size_t length;

    memset(variants, 0, sizeof *variants);
    for (uint32_t i = 0; !list && i < REFOCUS_METHOD_COUNT; i++)
        if (disc || !(refocus_method_traits(i) & REFOCUS_METHOD_DISC_ONLY))
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s,", refocus_method_name(i));
    list = list ? list : all;
    length = strlen(list) + 1;
    /* the list, its entries, and their options with two dashes for a colon */
    variants->words = malloc(4 * length);
    if (!variants->words)
        return report_failure(EXIT_FAILED, "--methods", "not enough memory");
    memcpy(variants->words, list, length);
    words = variants->words + length;
    return add_all(variants, variants->words, &words, common);
}

void variants_end(struct variants *variants)
{
    for (int i = 0; i < variants->count; i++)
        engine_end(&variants->variant[i].engine);
    free(variants->words);
}
