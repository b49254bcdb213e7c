/* load.h: a whole file is read into memory. */
#ifndef RF_FILE_LOAD_H
#define RF_FILE_LOAD_H

#include <refocus/platform/file.h>

int rf_load(const char *path, uint64_t max_bytes, struct refocus_reason *reason,
            struct refocus_blob *blob);

#endif
