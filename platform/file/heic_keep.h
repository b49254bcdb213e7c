/* heic_keep.h: the XMP packet of a HEIC. */
#ifndef RF_FILE_HEIC_KEEP_H
#define RF_FILE_HEIC_KEEP_H

#include <libheif/heif.h>
#include "reading.h"

/* Keep it for pictures that are made from the photo. A result of ours has its all-in-focus original
 * and depth in it, which are taken. */
int rf_heic_keep(struct rf_read *read, const struct heif_image_handle *primary);

#endif
