/* jpeg_decode.h: the pixels of a JPEG are decoded by TurboJPEG. */
#ifndef RF_FILE_JPEG_DECODE_H
#define RF_FILE_JPEG_DECODE_H

#include "bytes.h"
#include "reading.h"

int rf_jpeg_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster);

#endif
