/* load.h: a whole file is read into memory. */
#ifndef RF_FILE_LOAD_H
#define RF_FILE_LOAD_H

#include <stdbool.h>
#include <refocus/platform/file.h>
#include "bytes.h"

/* Read a file whole; but where it does not begin as is_known() wants, unless that is NULL, no more
 * than its beginning, which is enough to say why it is refused. */
int rf_load(const char *path, uint64_t max_bytes, bool (*is_known)(struct rf_bytes beginning),
            struct refocus_reason *reason, struct refocus_blob *blob);

#endif
