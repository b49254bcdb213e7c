/* dynamic.h: Google's Dynamic Depth becomes samples and their meaning. */
#ifndef RF_FILE_DYNAMIC_H
#define RF_FILE_DYNAMIC_H

#include "bytes.h"
#include "reading.h"
#include "xmp.h"

/* Look through the container directories of the XMP for depth, which lies behind the main
 * picture's end, and fill read->samples, read->depth and the info; nothing happens when there are
 * samples already, or none. */
int rf_read_dynamic(struct rf_read *read, struct rf_bytes file, const struct rf_xmp *xmp,
                    size_t main_end);

#endif
