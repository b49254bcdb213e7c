/* apple.h: Apple's depth in a JPEG becomes samples and their meaning. */
#ifndef RF_FILE_APPLE_H
#define RF_FILE_APPLE_H

#include "bytes.h"
#include "reading.h"

/* Look through the pictures that the MPF index names, behind the main picture's end, and fill
 * read->samples, read->depth and the info from the one that is depth. */
int rf_read_apple(struct rf_read *read, struct rf_bytes file, struct rf_bytes mpf, size_t main_end);

/* Read the gain map and the portrait matte that kept.c puts behind the original of a result. */
int rf_read_companions(struct rf_read *read, struct rf_bytes original);

#endif
