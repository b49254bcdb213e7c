/* png_read.h: a PNG is decoded, and read with its EXIF and colour profile, by libpng. */
#ifndef RF_FILE_PNG_READ_H
#define RF_FILE_PNG_READ_H

#include "bytes.h"
#include "reading.h"

int rf_read_png(struct rf_read *read, struct rf_bytes file);
/* The pixels alone. */
int rf_png_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster);

#endif
