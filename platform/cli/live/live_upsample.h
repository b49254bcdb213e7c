/* live_upsample.h: depth of each frame is brought to the photo's size as --upsample asks for. */
#ifndef RF_CLI_LIVE_UPSAMPLE_H
#define RF_CLI_LIVE_UPSAMPLE_H

#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "live/live_depth.h"

/* Put a map of the photo's size in place of a map of another, in memory that `full` owns, by a way
 * of upsample_words; the core's is left to the renderer. Returns what upsample_by_filter()
 * returns. */
int live_upsample(struct live_depth_map *full, const struct live_depth_map **map,
                  const struct refocus_image *photo, int way, struct refocus_reason *reason);

#endif
