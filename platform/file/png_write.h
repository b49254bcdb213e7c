/* png_write.h: a PNG is written by libpng. */
#ifndef RF_FILE_PNG_WRITE_H
#define RF_FILE_PNG_WRITE_H

#include "rows.h"
#include "store.h"

int rf_write_png(struct rf_store *store, const struct rf_rows *rows,
                 const struct refocus_write_options *options, struct refocus_reason *reason);

#endif
