/* bytes.h: a stretch of memory that somebody else owns, as readers hand it to each other. */
#ifndef RF_FILE_BYTES_H
#define RF_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>

struct rf_bytes {
    const uint8_t *data;
    size_t size;
};

#endif
