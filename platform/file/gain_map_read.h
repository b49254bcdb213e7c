/* gain_map_read.h: the gain map that lies behind the main picture of a JPEG is read. */
#ifndef RF_FILE_GAIN_MAP_READ_H
#define RF_FILE_GAIN_MAP_READ_H

#include "bytes.h"
#include "gain_map.h"
#include "reading.h"
#include "xmp.h"

/* Look for a gain map behind main_end, and read it into read->gain. A damaged one is passed over:
 * the photo is whole without it. mpf_tiff.data NULL: the file has no MPF index. */
int rf_read_gain_map(struct rf_read *read, struct rf_bytes file, struct rf_bytes mpf_tiff,
                     size_t main_end);

/* The headroom of an Apple map by the XMP beside it, else by the photo's EXIF. Returns NULL, or why
 * the map is of no use. */
const char *rf_gain_from_apple(const struct rf_read *read, const struct rf_xmp *xmp,
                               double *headroom);

/* Settle and note what was read into map->samples, and by Apple's curve where headroom > 0; or
 * free it and note why it is of no use. */
void rf_gain_settle(struct rf_read *read, const char *why, double headroom);

#endif
