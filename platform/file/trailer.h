/* trailer.h: depth that phones put behind a JPEG in a way of their own becomes samples. */
#ifndef RF_FILE_TRAILER_H
#define RF_FILE_TRAILER_H

#include "bytes.h"
#include "reading.h"

/* Look behind the main picture's end for the trailer of Samsung or Huawei, and fill read->samples,
 * read->depth and the info; nothing happens when there are samples already, or none. Maps that are
 * damaged are passed over. */
int rf_read_trailer(struct rf_read *read, struct rf_bytes file, size_t main_end);

#endif
