/* heic_xmp.h: what the XMP beside a picture of a HEIC says of it. */
#ifndef RF_FILE_HEIC_XMP_H
#define RF_FILE_HEIC_XMP_H

#include <libheif/heif.h>
#include "reading.h"
#include "xmp.h"

/* Parse the first packet of an auxiliary picture; rf_xmp_free() ends *xmp, which has no values
 * where there is no packet or a damaged one. Returns REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_heic_parse_xmp(const struct rf_read *read, const struct heif_image_handle *handle,
                      struct rf_xmp *xmp);

#endif
