/* part.h: a PNG or JPEG that lies inside another file is decoded. */
#ifndef RF_FILE_PART_H
#define RF_FILE_PART_H

#include "bytes.h"
#include "reading.h"

/* Decode the plain picture: no depth and no orientation are looked for. `what` names the part in
 * the words of an error. */
int rf_decode_part(const struct rf_read *read, struct rf_bytes part, const char *what,
                   struct rf_raster *raster);

/* Pixels that a part claims to have, to be known before any is decoded; 0 for no PNG or JPEG. */
uint64_t rf_part_pixels(struct rf_bytes part);

#endif
