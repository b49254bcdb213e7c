/* upsample.h: a small depth map is brought to the photo's size by a filter of OpenCV. */
#ifndef RF_CLI_UPSAMPLE_H
#define RF_CLI_UPSAMPLE_H

#include <stdint.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "line/option.h"

/* Words of --upsample: "core" and the filters of OpenCV. */
extern const struct option_word upsample_words[];

/* Whether this build has that way; an exit code, and prints why not. */
int upsample_check(int way);

/* Enlarge the map to packed disparities of the photo's size by a way other than the core's, which
 * is 0. Returns REFOCUS_OK or an error with the reason. */
int upsample_by_filter(int way, const struct refocus_image *photo,
                       const struct refocus_disparity *map, uint16_t *out,
                       struct refocus_reason *reason);

#endif
