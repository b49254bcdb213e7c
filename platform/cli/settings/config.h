/* config.h: the configuration file, which has the user's defaults and presets, and the presets that
 * come with the command.
 *
 *     # options of every `refocus render`
 *     [render]
 *     quality = best
 *     threads = 2
 *
 *     # refocus render PHOTO -o OUT --preset evening
 *     [preset evening]
 *     f-number = 1.4
 *     bokeh = classic
 *     no-dither = yes
 *
 * A key is an option without its dashes, its value is as on the command line; flags are yes or no.
 * Lines that begin with # are comments. A preset goes with all commands that make pictures, each of
 * which takes the options that it has. What comes later overrules what came before: the section of
 * the command, the preset, a file of settings, the command line.
 */
#ifndef RF_CLI_CONFIG_H
#define RF_CLI_CONFIG_H

#include "line/option.h"

enum { CONFIG_MOST_BYTES = 1 << 20 };

/* Rows for tables of options, before that of a file of settings. A file of settings makes the same
 * picture for everybody, so that beside one defaults count only when they are asked for. */
#define CONFIG_OPTIONS(type, file, preset, short_help)                                             \
    {OPTION(OPTION_TEXT, "--config", "FILE|none", type, file), .load = config_load,                \
     .unless = "--settings",                                                                       \
     .help = "options of every call, and presets; default: refocus/config in "                     \
             "$XDG_CONFIG_HOME or ~/.config, if it is there, but not beside --settings",           \
     .elsewhere = true},                                                                           \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--preset", "NAME", type, preset),                                     \
            .load = config_load_preset, .choice = config_preset_name,                              \
            .summary = config_preset_summary, .brief = short_help,                                 \
            .help = "several options at once, which other options overrule: a preset of the "      \
                    "configuration file, or",                                                      \
            .elsewhere = true                                                                      \
    }

/* Presets that come with the command; NULL ends them. */
const char *config_preset_name(uint32_t index);
const char *config_preset_summary(uint32_t index);

/* Take the section of the command from a configuration file; NULL: the user's, if there is one. */
int config_load(const struct command *command, const char *file, void *settings);

/* Take a section or "preset NAME" from memory; `file` is what errors call it. What was read before
 * is forgotten, and with it the texts of those settings. *found: there is such a section. */
int config_read(const struct command *command, const char *file, const char *bytes, size_t size,
                const char *section, void *settings, bool *found);

/* Take a preset; after config_load(), if that is called. */
int config_load_preset(const struct command *command, const char *name, void *settings);

#endif
