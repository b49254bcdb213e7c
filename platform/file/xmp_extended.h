/* xmp_extended.h: an extended XMP packet is put together from its chunks in a JPEG. */
#ifndef RF_FILE_XMP_EXTENDED_H
#define RF_FILE_XMP_EXTENDED_H

#include "bytes.h"
#include "reading.h"

/* Put the chunks of one GUID together, in whatever order they come. */
int rf_xmp_extended(struct rf_read *read, struct rf_bytes jpeg, const char *guid,
                    size_t guid_length, struct refocus_blob *packet);

#endif
