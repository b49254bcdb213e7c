/* shot_options.h: the options of rendering, as groups for the tables of commands. */
#ifndef RF_CLI_SHOT_OPTIONS_H
#define RF_CLI_SHOT_OPTIONS_H

#include "line/option.h"

/* These are of struct engine_settings. Search and blend are in `rendering_options`, too. */
extern const struct option method_options[], ray_options[], rendering_options[];
extern const struct option search_options[], blend_options[];
extern const struct option control_options[], bokeh_options[], paper_options[];
extern const struct option run_options[], repeat_options[], strips_options[];

/* These are of struct shot_settings. */
extern const struct option shot_lens_options[], shot_method_options[];

/* usual: the quality that is the default; summaries: what each of them is, or NULL. */
#define QUALITY_OPTION(type, field, usual, summaries)                                              \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--quality", "NAME", type, field),                                   \
            .words = engine_quality_words, .summary = summaries,                                   \
            .brief = "time against smoothness",                                                    \
            .help = "presets; default " usual "; --rays overrules"                                 \
    }

#endif
