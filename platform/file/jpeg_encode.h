/* jpeg_encode.h: pixels become a JPEG in memory, into which segments can be put. */
#ifndef RF_FILE_JPEG_ENCODE_H
#define RF_FILE_JPEG_ENCODE_H

#include <refocus/platform/file.h>
#include "rows.h"

struct rf_jpeg_encoded {
    unsigned char *bytes;
    unsigned long size;
    unsigned long split; /* where segments belong: behind SOI and JFIF */
};

/* quality is 1 to 100. REFOCUS_OK, REFOCUS_ERR_UNSUPPORTED (it is too large for a JPEG) or
 * REFOCUS_ERR_MEMORY; rf_jpeg_encoded_free() ends it, whatever is returned. */
int rf_jpeg_encode(struct rf_jpeg_encoded *encoded, const struct rf_rows *rows, int quality,
                   struct refocus_reason *reason);
void rf_jpeg_encoded_free(struct rf_jpeg_encoded *encoded);

#endif
