/* gain_write.h: a gain map becomes a JPEG that says what it means. */
#ifndef RF_FILE_GAIN_WRITE_H
#define RF_FILE_GAIN_WRITE_H

#include "gain_map.h"

/* A JPEG with the values by ISO 21496-1 and by the XMP of Ultra HDR; the values of its channels are
 * the same, and multiples of 1 / 65536. free() ends the blob. REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_gain_write(struct refocus_blob *jpeg, const struct rf_gain_map *map,
                  struct refocus_reason *reason);

#endif
