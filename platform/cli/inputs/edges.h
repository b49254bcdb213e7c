/* edges.h: the edges of a depth map are put where the photo has them. */
#ifndef RF_CLI_EDGES_H
#define RF_CLI_EDGES_H

#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include "line/option.h"

enum edges { EDGES_AUTO, EDGES_AS_GIVEN };

/* Words of --depth-edges. */
extern const struct option_word edges_words[];

/* Make packed disparities of the photo's size, which the caller frees, of a map; an exit code, and
 * prints why. */
int edges_place(const struct refocus_image *photo, const struct refocus_disparity *map,
                uint16_t **placed, struct refocus_depth_edges_report *report, const char *name);

/* The report as JSON; null where edges were left as given. */
json_t *edges_json(const struct refocus_depth_edges_report *report);

#endif
