/* config.c: defaults and presets are taken from the configuration file and from those built in. */
#include "settings/config.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <refocus/platform/file.h>
#include "line/subcommands.h"
#include "line/options.h"
#include "line/report.h"

enum { NAME_LENGTH = 64, WHAT_LENGTH = 512, MOST_PAIRS = 8 };

struct pair {
    const char *key, *value;
};

static const struct preset {
    const char *name, *summary;
    struct pair pairs[MOST_PAIRS];
} presets[] = {
    {"portrait",
     "a fast lens, smooth discs, fine hair",
     {{"f-number", "1.8"}, {"bokeh", "smooth"}, {"quality", "best"}}},
    {"close-up",
     "as near and as blurred as a macro lens",
     {{"f-number", "1"}, {"quality", "best"}}},
    {"night", "lamps become discs of seven blades", {{"f-number", "1.4"}, {"bokeh", "classic"}}},
    {"swirl",
     "an old portrait lens that turns the background",
     {{"f-number", "1.4"}, {"bokeh", "swirl"}}},
    {"cinema", "upright ovals of an anamorphic lens", {{"f-number", "2"}, {"bokeh", "cine"}}},
    {"mirror", "rings of a mirror lens", {{"f-number", "2"}, {"bokeh", "ring"}}},
    {"draft", "quick, in little memory", {{"quality", "preview"}, {"low-memory", "yes"}}},
    {"paper",
     "Yang et al. 2016: their search, the values as stored, eq. 5",
     {{"method", "search"},
      {"iterations", "1"},
      {"background", "yes"},
      {"rays", "full"},
      {"blend", "stored"},
      {"sigma", "128"}}},
};

enum { PRESETS = sizeof presets / sizeof *presets };

const char *config_preset_name(uint32_t index)
{
    return index < PRESETS ? presets[index].name : NULL;
}

const char *config_preset_summary(uint32_t index)
{
    return index < PRESETS ? presets[index].summary : NULL;
}

/* A line "key = value" of the file. */
struct entry {
    const char *section, *key, *value;
    int line;
};

/* The file, once it was read. Settings point into its text, so that it stays to the end. */
static struct config {
    char *path, *text;
    struct entry *entries;
    size_t count;
    bool opened;
} config;

static void forget(void)
{
    free(config.path);
    free(config.text);
    free(config.entries);
    config = (struct config){.count = 0};
}

/* "FILE:3: key", for errors. */
static const char *place(char what[WHAT_LENGTH], int line, const char *key)
{
    char name[NAME_LENGTH];

    report_clean(name, sizeof name, key);
    snprintf(what, WHAT_LENGTH, "%.*s:%d: %s", WHAT_LENGTH - NAME_LENGTH - 16, config.path, line,
             name);
    return what;
}

static int damaged(int line, const char *key, const char *why)
{
    char what[WHAT_LENGTH];

    return report_failure(EXIT_FAILED, place(what, line, key), "%s", why);
}

static char *trim(char *text)
{
    size_t n;

    while (isspace((unsigned char)*text))
        text++;
    for (n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]); n--)
        text[n - 1] = '\0';
    return text;
}

/* The name of a preset's section, or NULL. */
static const char *preset_of(const char *section)
{
    return strncmp(section, "preset ", 7) == 0 ? section + 7 + strspn(section + 7, " ") : NULL;
}

static int add(const char *section, char *line, int number)
{
    char *value = strchr(line, '=');
    struct entry *entries;

    if (!value)
        return damaged(number, line, "is no 'key = value', and no [section]");
    if (!section)
        return damaged(number, line, "it is in no section; put [render] or [preset NAME] before");
    entries = realloc(config.entries, (config.count + 1) * sizeof *entries);
    if (!entries)
        return report_failure(EXIT_FAILED, config.path, "not enough memory");
    *value++ = '\0';
    config.entries = entries;
    config.entries[config.count++] = (struct entry){section, trim(line), trim(value), number};
    return OPTIONS_PARSED;
}

static int begin_section(const char **section, char *line, int number)
{
    char *end = strchr(line, ']');

    if (!end || end[1] != '\0')
        return damaged(number, line, "is no [section]");
    *end = '\0';
    *section = trim(line + 1);
    if (commands_find(*section) || preset_of(*section))
        return OPTIONS_PARSED;
    return damaged(number, *section, "unknown section; give a subcommand's, or [preset NAME]");
}

/* Parse the text, which gets a NUL behind each section, key and value. */
static int parse(void)
{
    const char *section = NULL;
    int status = OPTIONS_PARSED, number = 0;

    for (char *line = config.text, *next; line && status == OPTIONS_PARSED; line = next) {
        next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        number++;
        line = trim(line);
        if (*line == '[')
            status = begin_section(&section, line, number);
        else if (*line && *line != '#')
            status = add(section, line, number);
    }
    return status;
}

/* The user's file; NULL: there is none. */
static char *usual_path(void)
{
    const char *folder = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    const bool own = folder && *folder == '/';
    char *path = NULL;
    size_t size;

    if (!own && !(home && *home))
        return NULL;
    size = strlen(own ? folder : home) + sizeof "/.config/refocus/config";
    path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s/refocus/config", own ? folder : home, own ? "" : "/.config");
    if (path && access(path, F_OK) == 0)
        return path;
    free(path);
    return NULL;
}

/* Editors of Windows put a mark of UTF-8 in front. */
static int take_text(const char *bytes, size_t size)
{
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) {
        bytes += 3;
        size -= 3;
    }
    config.text = calloc(size + 1, 1);
    if (!config.text)
        return report_failure(EXIT_FAILED, config.path, "not enough memory");
    if (size > 0)
        memcpy(config.text, bytes, size);
    if (strlen(config.text) < size)
        return report_failure(EXIT_FAILED, config.path, "is no text: it holds bytes of 0");
    return parse();
}

/* Read the file, NULL the user's, if none was read yet. */
static int open_file(const char *file)
{
    struct refocus_reason reason = {{0}};
    struct refocus_blob blob;
    int status;

    if (config.opened)
        return OPTIONS_PARSED;
    config.opened = true;
    if (file && strcmp(file, "none") == 0)
        return OPTIONS_PARSED;
    if (atexit(forget) != 0)
        return report_failure(EXIT_FAILED, "--config", "not enough memory");
    config.path = file ? strdup(file) : usual_path();
    if (!config.path)
        return OPTIONS_PARSED;
    if (refocus_file_read(config.path, CONFIG_MOST_BYTES, &blob, &reason) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, config.path, "%s", reason.text);
    status = take_text((const char *)blob.data, blob.size);
    free(blob.data);
    return status;
}

static const struct option *find(const struct command *command, const char *key)
{
    char name[NAME_LENGTH + 2];

    snprintf(name, sizeof name, "--%s", key);
    return strlen(key) < NAME_LENGTH ? options_find(command, name) : NULL;
}

static bool is_of_another(const char *key)
{
    for (int i = 0; commands[i]; i++)
        if (find(commands[i], key))
            return true;
    return false;
}

static int unknown(const struct command *command, const struct entry *entry)
{
    char name[NAME_LENGTH + 2], why[WHAT_LENGTH];
    const char *nearest;

    snprintf(name, sizeof name, "--%s", entry->key);
    nearest = options_nearest_name(command, name);
    snprintf(why, sizeof why, "unknown setting%s%s%s", nearest ? "; did you mean '" : "",
             nearest ? nearest + strspn(nearest, "-") : "", nearest ? "'?" : "");
    return damaged(entry->line, entry->key, why);
}

static int set_flag(const struct option *option, const char *what, const char *value,
                    void *settings)
{
    const bool yes = strcmp(value, "yes") == 0 || strcmp(value, "true") == 0;

    if (!yes && strcmp(value, "no") != 0 && strcmp(value, "false") != 0)
        return report_failure(EXIT_FAILED, what, "'%s' cannot be used; give yes or no", value);
    *(bool *)((char *)settings + option->offset) = yes;
    return OPTIONS_PARSED;
}

/* Give an option of a preset or section its value. `what` is its name in errors. */
static int set(const struct option *option, const char *what, const char *value, void *settings)
{
    int status;

    if (option->kind == OPTION_FLAG)
        return set_flag(option, what, value, settings);
    status = options_set(option, what, value, settings);
    return status == EXIT_WRONG ? EXIT_FAILED : status;
}

static int set_entry(const struct command *command, const struct entry *entry, void *settings)
{
    const struct option *option = find(command, entry->key);
    char what[WHAT_LENGTH];

    if (!option)
        return preset_of(entry->section) && is_of_another(entry->key) ? OPTIONS_PARSED
                                                                      : unknown(command, entry);
    if (option->elsewhere && option->kind == OPTION_TEXT)
        return damaged(entry->line, entry->key,
                       "it is for one call alone; give it on the command line");
    return set(option, place(what, entry->line, entry->key), entry->value, settings);
}

/* Take what is between `section` and the next one. *found: there is such a section. */
static int take(const struct command *command, const char *section, void *settings, bool *found)
{
    const char *wanted = preset_of(section);
    int status = OPTIONS_PARSED;

    for (int run = 0; run < 2; run++)
        for (size_t i = 0; i < config.count && status == OPTIONS_PARSED; i++) {
            const struct entry *entry = &config.entries[i];
            const char *name = preset_of(entry->section);
            const struct option *option = find(command, entry->key);

            if (wanted ? !name || strcmp(name, wanted) != 0 : strcmp(entry->section, section) != 0)
                continue;
            *found = true;
            if (run == 0 && option)
                options_clear_rivals(command, option, settings);
            else if (run == 1)
                status = set_entry(command, entry, settings);
        }
    return status;
}

int config_read(const struct command *command, const char *file, const char *bytes, size_t size,
                const char *section, void *settings, bool *found)
{
    int status;

    forget();
    *found = false;
    config.path = strdup(file);
    if (!config.path)
        return report_failure(EXIT_FAILED, file, "not enough memory");
    status = take_text(bytes, size);
    return status == OPTIONS_PARSED ? take(command, section, settings, found) : status;
}

int config_load(const struct command *command, const char *file, void *settings)
{
    bool found = false;
    const int status = open_file(file);

    return status == OPTIONS_PARSED ? take(command, command->name, settings, &found) : status;
}

/* Names of presets: those of the command first, then one for each line of the file's. */
static const char *any_preset(const void *list, int i)
{
    (void)list;
    if (i < PRESETS)
        return presets[i].name;
    i -= PRESETS;
    for (size_t k = 0; k < config.count; k++) {
        const char *name = preset_of(config.entries[k].section);

        if (name && i-- == 0)
            return name;
    }
    return NULL;
}

static int take_built_in(const struct command *command, const struct preset *preset, void *settings)
{
    int status = OPTIONS_PARSED;

    for (int i = 0; i < MOST_PAIRS && preset->pairs[i].key && status == OPTIONS_PARSED; i++) {
        const struct option *option = find(command, preset->pairs[i].key);

        if (!option)
            continue; /* this command has no such option */
        options_clear_rivals(command, option, settings);
        status = set(option, preset->name, preset->pairs[i].value, settings);
    }
    return status;
}

int config_load_preset(const struct command *command, const char *name, void *settings)
{
    char section[NAME_LENGTH + 8];
    const char *nearest;
    bool found = false;
    int status = open_file(NULL);

    snprintf(section, sizeof section, "preset %.*s", NAME_LENGTH - 1, name);
    if (status == OPTIONS_PARSED)
        status = take(command, section, settings, &found);
    if (found || status != OPTIONS_PARSED)
        return status;
    for (int i = 0; i < PRESETS; i++)
        if (strcmp(presets[i].name, name) == 0)
            return take_built_in(command, &presets[i], settings);
    nearest = options_nearest(name, any_preset, NULL);
    if (nearest)
        return report_failure(EXIT_WRONG, "--preset", "'%s' is not known; did you mean %s?", name,
                              nearest);
    return report_failure(EXIT_WRONG, "--preset",
                          "'%s' is not known; 'refocus %s --help-all' lists those built in", name,
                          command->name);
}
