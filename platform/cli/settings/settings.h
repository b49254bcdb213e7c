/* settings.h: files of settings: one JSON object that describes a picture, whose members are
 * options.
 *
 *     {
 *       "refocus": 1,
 *       "focus": 0.25,
 *       "blur": 24,
 *       "aperture": "polygon:6:15",
 *       "quality": "best",
 *       "region": [0, 0, 640, 480],
 *       "mirror": true
 *     }
 *
 * "refocus" is the version of the format and has to be there. Every other member is an
 * option of the command without its dashes; its value is a number, a text, true (of
 * flags) or an array of numbers, of the ranges that the option has on the command line.
 * Names of files are as on the command line, from the folder that the command runs in.
 * What the command line says overrules the file.
 */
#ifndef RF_CLI_SETTINGS_H
#define RF_CLI_SETTINGS_H

#include <jansson.h>
#include "line/option.h"

enum { SETTINGS_VERSION = 1, SETTINGS_MOST_BYTES = 1 << 20 };

/* Rows for tables of options. */
#define SETTINGS_OPTION(type, member)                                                              \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--settings", "FILE", type, member),                                   \
            .load = settings_load,                                                                 \
            .help = "JSON object of options; the command line overrules it", .elsewhere = true     \
    }
#define SAVE_SETTINGS_OPTION(type, save)                                                           \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--save-settings", "FILE", type, save),                                \
            .help = "write the options that make this picture as JSON for --settings",             \
            .elsewhere = true                                                                      \
    }

/* Read a file of settings; OPTIONS_PARSED, or the exit code after an error, which is
 * printed. Texts live as long as the program. */
int settings_load(const struct command *command, const char *file, void *settings);

/* A text as JSON, or NULL, after the failure has been reported. */
json_t *settings_parse(const char *file, const char *bytes, size_t size);

/* Read it from memory; `file` is what errors call it. */
int settings_read(const struct command *command, const char *file, const char *bytes, size_t size,
                  void *settings);

/* Take them from an object, which need not say its version; all texts that were read before are
 * forgotten. */
int settings_take(const struct command *command, const char *file, json_t *root, void *settings);

/* Forget the texts that were read, as is done when the program ends. */
void settings_forget(void);

/* Check before the work that a file of settings can be written there, and is none of the inputs. */
int settings_check(const char *file, const char *const *inputs, int input_count);

/* The text of a file of these settings, to be freed; NULL without memory, or where a file's name is
 * not UTF-8. */
char *settings_dump(const struct command *command, const void *settings);

/* Write a file of these settings, whole or not at all; an exit code. */
int settings_save(const struct command *command, const char *file, const void *settings);

#endif
