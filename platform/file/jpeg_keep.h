/* jpeg_keep.h: a JPEG that is written keeps the segments of the photo it was made from. */
#ifndef RF_FILE_JPEG_KEEP_H
#define RF_FILE_JPEG_KEEP_H

#include "jpeg_behind.h"
#include "rows.h"
#include "store.h"

/* Write XMP and all other segments of options->keep that still hold, and what XMP says of what lies
 * behind the picture. Depth is dropped from that where there is no room for it. */
int rf_jpeg_put_kept(struct rf_store *store, const struct refocus_write_options *options,
                     const struct rf_rows *rows, struct rf_behind *behind,
                     struct refocus_reason *reason);
/* Put the density of options->keep, pixels per inch, into the JFIF segment at the begin of a
 * JPEG. */
void rf_jpeg_keep_density(const struct refocus_write_options *options, uint8_t *jpeg, size_t size);

#endif
