/* gain_values.h: what the metadata of gain maps says, in each of its forms. */
#ifndef RF_FILE_GAIN_VALUES_H
#define RF_FILE_GAIN_VALUES_H

#include "bytes.h"
#include "gain_map.h"
#include "xmp.h"

/* These return NULL, or why the values are of no use, and fill all of them. */

/* The metadata of ISO 21496-1, from the version on. */
const char *rf_gain_from_iso(struct rf_bytes metadata, struct rf_gain_values *values);
/* The properties hdrgm: of Ultra HDR. */
const char *rf_gain_from_xmp(const struct rf_xmp *xmp, struct rf_gain_values *values);

/* Fill map->gain by its values; then, instead, by Apple's curve up to a headroom over white. */
void rf_gain_make_curves(struct rf_gain_map *map);
void rf_gain_make_apple(struct rf_gain_map *map, double headroom);

#endif
