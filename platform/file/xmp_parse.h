/* xmp_parse.h: XMP packets are read by expat. */
#ifndef RF_FILE_XMP_PARSE_H
#define RF_FILE_XMP_PARSE_H

#include "bytes.h"
#include "xmp.h"

/* Add a packet's properties; the first value of each stays. On an error the struct holds what was
 * read and is freed as ever. */
int rf_xmp_parse(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp *xmp);

#endif
