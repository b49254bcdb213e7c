/* tiff.h: the two halves of the module of TIFF. */
#ifndef RF_TIFF_H
#define RF_TIFF_H

#include "codec.h"

int rf_tiff_read(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras);
int rf_tiff_write(struct refocus_blob *file, const struct rf_rows *rows,
                  const struct rf_extras *extras, struct refocus_reason *reason);

#endif
