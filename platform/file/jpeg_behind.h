/* jpeg_behind.h: pictures that lie behind the main one in a JPEG that is written. */
#ifndef RF_FILE_JPEG_BEHIND_H
#define RF_FILE_JPEG_BEHIND_H

#include "behind.h"
#include "rows.h"
#include "store.h"

/* Make those that the options ask for; rf_behind_free() ends them, whatever is returned. */
int rf_behind_make(struct rf_behind *behind, const struct rf_rows *rows,
                   const struct refocus_write_options *options, struct refocus_reason *reason);
/* Put elements rdf:Description, or nothing, for the XMP of the main picture. */
void rf_behind_put_xmp(struct rf_text *text, const struct rf_behind *behind,
                       const struct refocus_write_options *options);
/* The last segments of the main picture, of which so many bytes are left to be written: MPF and the
 * mark of ISO 21496-1, for a gain map. */
void rf_behind_put_index(struct rf_store *store, const struct rf_behind *behind, size_t left);
void rf_behind_put(struct rf_store *store, const struct rf_behind *behind);

#endif
