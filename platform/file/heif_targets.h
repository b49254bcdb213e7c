/* heif_targets.h: metadata and auxiliary images of a HEIF container belong to one picture each, as
 * libheif wants it. */
#ifndef RF_FILE_HEIF_TARGETS_H
#define RF_FILE_HEIF_TARGETS_H

#include <refocus/refocus.h>

#include "bytes.h"

/* Where some belong to several pictures, *changed becomes a copy of the file, as long as it, in
 * which they belong to one; the caller frees it. NULL: the file may be read as it is. Returns
 * REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_heif_single_targets(struct rf_bytes file, uint8_t **changed);

#endif
