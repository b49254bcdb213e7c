/* heic_write.h: pictures are written as HEIC. */
#ifndef RF_FILE_HEIC_WRITE_H
#define RF_FILE_HEIC_WRITE_H

#include "rows.h"
#include "store.h"
#include <refocus/platform/file.h>

int rf_write_heic(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason);

#endif
