/* heic_keep.h: bytes of a HEIC that pictures made from it keep. */
#ifndef RF_FILE_HEIC_KEEP_H
#define RF_FILE_HEIC_KEEP_H

#include <libheif/heif.h>
#include "reading.h"

int rf_heic_keep(struct rf_read *read, const struct heif_image_handle *primary);

#endif
