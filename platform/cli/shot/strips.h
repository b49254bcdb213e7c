/* strips.h: a photo is rendered in strips, which takes little memory. */
#ifndef RF_CLI_STRIPS_H
#define RF_CLI_STRIPS_H

#include "inputs/read_input.h"
#include "shot/engine.h"

/* Refuse options that cannot be met in strips, and leave out what was not asked for; an exit
 * code, and prints why. */
int strips_check(const struct engine_settings *engine, struct depth_settings *depth, bool behind);

/* Whether a photo may be rendered in strips though nobody asked for it: strips_check() would refuse
 * nothing, and only what --low-memory says differs. */
bool strips_suit(const struct engine_settings *engine, const struct depth_settings *depth,
                 bool behind);

/* Make packed disparities of the photo's size, which the caller frees, of those of its map; an
 * exit code, and prints why. The report is written where edges are placed. */
int strips_disparity(const struct input *input, bool places_edges,
                     const struct engine_settings *engine, uint16_t **full,
                     struct refocus_depth_edges_report *report);

#endif
