/* jpeg_read.h: a JPEG photo is read: its segments, its depth and its picture. */
#ifndef RF_FILE_JPEG_READ_H
#define RF_FILE_JPEG_READ_H

#include "bytes.h"
#include "reading.h"

int rf_read_jpeg(struct rf_read *read, struct rf_bytes file);

#endif
