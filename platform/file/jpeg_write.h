/* jpeg_write.h: a JPEG is written by TurboJPEG. */
#ifndef RF_FILE_JPEG_WRITE_H
#define RF_FILE_JPEG_WRITE_H

#include "rows.h"
#include "store.h"

int rf_write_jpeg(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason);

#endif
