/* settings.c: files of settings are read and written. */
#include "settings/settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include <refocus/platform/file.h>
#include "outputs/outputs.h"
#include "line/report.h"

enum { LONGEST_NAME = 64, LONGEST_VALUE = 256 };

/* Settings point into texts of the files that were read; all are freed at the end. */
static json_t *kept;

void settings_forget(void)
{
    json_decref(kept);
    kept = NULL;
}

static bool keep(json_t *root)
{
    static bool at_exit;

    if (!at_exit && atexit(settings_forget) != 0)
        return false;
    at_exit = true;
    if (!kept)
        kept = json_array();
    return kept && json_array_append(kept, root) == 0;
}

/* The name by which errors call a member of a file. */
static const char *member_name(char what[LONGEST_VALUE], const char *file, const char *key)
{
    char name[LONGEST_NAME];

    report_clean(name, sizeof name, key);
    snprintf(what, LONGEST_VALUE, "%.*s: %s", LONGEST_VALUE - LONGEST_NAME - 3, file, name);
    return what;
}

static int damaged(const char *file, const char *key, const char *why)
{
    char what[LONGEST_VALUE];

    member_name(what, file, key);
    return report_failure(EXIT_FAILED, what, "%s", why);
}

/* Write a number as the command line has it; false: there is no text for it. */
static bool number_text(const json_t *value, char *text, size_t size)
{
    if (json_is_integer(value))
        return snprintf(text, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value)) > 0;
    if (!json_is_real(value))
        return false;
    return snprintf(text, size, "%.17g", json_real_value(value)) > 0;
}

/* Write an array of numbers as "1,2,3". */
static bool numbers_text(const json_t *array, char *text, size_t size)
{
    const json_t *value;
    size_t i, n = 0;

    json_array_foreach(array, i, value)
    {
        if (n + 32 > size)
            return false;
        if (i > 0)
            text[n++] = ',';
        if (!number_text(value, text + n, size - n))
            return false;
        n += strlen(text + n);
    }
    return n > 0;
}

static int set_member(const struct command *command, const char *file, const char *key,
                      const json_t *value, void *settings)
{
    char name[LONGEST_NAME + 2], text[LONGEST_VALUE], what[LONGEST_VALUE];
    const struct option *option;
    const char *given = text;
    int status;

    snprintf(name, sizeof name, "--%s", key);
    option = strlen(key) < LONGEST_NAME ? options_find(command, name) : NULL;
    if (!option || option->elsewhere) {
        const char *nearest = options_nearest_name(command, name);
        char why[LONGEST_VALUE];

        if (option)
            return damaged(file, key, "does not describe the picture; give it on the command line");
        snprintf(why, sizeof why, "unknown setting%s%s%s", nearest ? "; did you mean '" : "",
                 nearest ? nearest + strspn(nearest, "-") : "", nearest ? "'?" : "");
        return damaged(file, key, why);
    }
    if (option->kind == OPTION_FLAG) {
        if (!json_is_boolean(value))
            return damaged(file, key, "give true or false");
        *(bool *)((char *)settings + option->offset) = json_is_true(value);
        return OPTIONS_PARSED;
    }
    if (json_is_string(value))
        given = json_string_value(value);
    else if (!number_text(value, text, sizeof text) && !numbers_text(value, text, sizeof text))
        return damaged(file, key,
                       option->kind == OPTION_NUMBERS ? "give numbers, as [1, 2]"
                                                      : "give a number or a text");
    status = options_set(option, member_name(what, file, key), given, settings);
    return status == EXIT_WRONG ? EXIT_FAILED : status;
}

static int set_members(const struct command *command, const char *file, json_t *root,
                       void *settings)
{
    int status = OPTIONS_PARSED;
    const char *key;
    json_t *value;

    if (!keep(root))
        return report_failure(EXIT_FAILED, file, "not enough memory");
    json_object_foreach(root, key, value)
    {
        if (strcmp(key, "refocus") == 0)
            continue;
        status = set_member(command, file, key, value, settings);
        if (status != OPTIONS_PARSED)
            break;
    }
    return status;
}

static bool is_version(const json_t *value)
{
    return json_is_integer(value) && json_integer_value(value) == SETTINGS_VERSION;
}

static int not_settings(const char *file)
{
    return report_failure(EXIT_FAILED, file,
                          "holds no settings: its member \"refocus\" should be %d",
                          SETTINGS_VERSION);
}

int settings_take(const struct command *command, const char *file, json_t *root, void *settings)
{
    const json_t *const version = json_object_get(root, "refocus");

    settings_forget();
    if (!json_is_object(root) || (version && !is_version(version)))
        return not_settings(file);
    return set_members(command, file, root, settings);
}

int settings_read(const struct command *command, const char *file, const char *bytes, size_t size,
                  void *settings)
{
    json_t *const root = settings_parse(file, bytes, size);
    int status;

    if (!root)
        return EXIT_FAILED;
    status = is_version(json_object_get(root, "refocus"))
                 ? set_members(command, file, root, settings)
                 : not_settings(file);
    json_decref(root);
    return status;
}

int settings_load(const struct command *command, const char *file, void *settings)
{
    struct refocus_reason reason = {{0}};
    struct refocus_blob blob;
    int status = refocus_file_read(file, SETTINGS_MOST_BYTES, &blob, &reason);

    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, file, "%s", reason.text);
    status = settings_read(command, file, (const char *)blob.data, blob.size, settings);
    free(blob.data);
    return status;
}

int settings_check(const char *file, const char *const *inputs, int input_count)
{
    static const char *const endings[] = {".json", NULL};

    return output_check(file, 0, endings, inputs, input_count);
}

/* Digits that a number needs to be read back as it is. */
static int digits_of(double value)
{
    for (int digits = 15; digits < 17; digits++) {
        char text[32];

        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            return digits;
    }
    return 17;
}

/* A whole number where it is one, so that files look as people write them. */
static json_t *number_json(double value, int *digits)
{
    *digits = digits_of(value) > *digits ? digits_of(value) : *digits;
    return value == floor(value) && fabs(value) < 1e15 ? json_integer((json_int_t)value)
                                                       : json_real(value);
}

/* The member of an option; NULL: it was not given, or *failed. */
static json_t *member_of(const struct option *option, const void *settings, int *digits,
                         bool *failed)
{
    const void *at = (const char *)settings + option->offset;
    const double *number = at;
    json_t *json = NULL;

    switch (option->kind) {
    case OPTION_FLAG:
        return *(const bool *)at ? json_true() : NULL;
    case OPTION_CHOICE:
        if (option->omits_default && *(const int *)at == 0)
            return NULL;
        json = json_string(options_word(option, (uint32_t) * (const int *)at));
        break;
    case OPTION_TEXT:
        if (!*(const char *const *)at)
            return NULL;
        json = json_string(*(const char *const *)at);
        break;
    case OPTION_NUMBER:
    case OPTION_INTEGER:
        if (isnan(*number))
            return NULL;
        if (option->word && *number == option->word_value)
            json = json_string(option->word);
        else if (option->other_word && *number == option->other_value)
            json = json_string(option->other_word);
        else
            json = isinf(*number) ? json_string("inf") : number_json(*number, digits);
        break;
    case OPTION_NUMBERS:
        if (isnan(*number))
            return NULL;
        json = json_array();
        for (int i = 0; json && i < option->count; i++)
            if (json_array_append_new(json, number_json(number[i], digits)) != 0)
                *failed = true;
        break;
    case OPTION_HEADING:
        return NULL;
    }
    *failed = *failed || !json;
    return json;
}

char *settings_dump(const struct command *command, const void *settings)
{
    json_t *root = json_pack("{s:i}", "refocus", (int)SETTINGS_VERSION);
    bool failed = !root;
    char *text = NULL;
    int digits = 15;

    for (const struct option *option = options_of(command); option->help && !failed; option++) {
        json_t *json = option->elsewhere ? NULL : member_of(option, settings, &digits, &failed);

        if (json && json_object_set_new(root, option->name + 2, json) != 0)
            failed = true;
    }
    if (!failed)
        text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION((size_t)digits));
    json_decref(root);
    return text;
}

int settings_save(const struct command *command, const char *file, const void *settings)
{
    char *const text = settings_dump(command, settings);
    int status;

    if (text)
        status = output_write_file(file, text, strlen(text));
    else
        status =
            report_failure(EXIT_FAILED, file, "not enough memory, or a file's name is not UTF-8");
    free(text);
    return status;
}
