/* heic_deep.h: HEIC and AVIF of more than 8 bits. */
#ifndef RF_FILE_HEIC_DEEP_H
#define RF_FILE_HEIC_DEEP_H

#include <libheif/heif.h>
#include "reading.h"

bool rf_heic_is_avif(struct rf_bytes file);
/* The layout of 16 bits a channel in the machine's byte order. */
enum heif_chroma rf_heic_deep_chroma(void);
/* Whether codes of more than 8 bits are light, by the curve of PQ, HLG or none. */
bool rf_heic_is_light(const struct heif_image_handle *handle);
/* Codes of PQ and HLG become light. */
int rf_heic_settle_light(struct rf_read *read, const struct heif_image_handle *handle);

#endif
