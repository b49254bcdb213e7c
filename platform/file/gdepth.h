/* gdepth.h: Google's depth in XMP becomes samples and their meaning. */
#ifndef RF_FILE_GDEPTH_H
#define RF_FILE_GDEPTH_H

#include "reading.h"
#include "xmp.h"

/* Fill read->samples, read->depth and the info; nothing happens when there is no GDepth. */
int rf_read_gdepth(struct rf_read *read, struct rf_xmp *xmp);

#endif
