/* heic_read.h: a HEIC photo is read by libheif. */
#ifndef RF_FILE_HEIC_READ_H
#define RF_FILE_HEIC_READ_H

#include "bytes.h"
#include "reading.h"

int rf_read_heic(struct rf_read *read, struct rf_bytes file);

#endif
