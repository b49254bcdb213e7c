/* upsample.h: a small depth map is brought to the photo's size by a filter of OpenCV. */
#ifndef RF_CLI_UPSAMPLE_H
#define RF_CLI_UPSAMPLE_H

#include <stdint.h>
#include <refocus/refocus.h>

/* Words of --upsample: "core" and the filters of OpenCV; NULL ends them. */
const char *upsample_name(uint32_t index);
/* Enlarge the map by one of OpenCV's filters to the width and height of the photo; an exit code,
 * and prints why. */
int upsample_by_filter(uint32_t filter, const struct refocus_image *photo,
                       const struct refocus_disparity *map, uint16_t *out, const char *name);

#endif
