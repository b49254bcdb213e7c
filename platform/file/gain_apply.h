/* gain_apply.h: the light that a base rendition and its gain map stand for. */
#ifndef RF_FILE_GAIN_APPLY_H
#define RF_FILE_GAIN_APPLY_H

#include "gain_map.h"

/* Fill width * height pixels of three linear halves, without gaps, of a base rendition of 8 bits.
 * REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_gain_apply(const struct rf_gain_map *map, const struct refocus_image *base, uint16_t *light);

#endif
