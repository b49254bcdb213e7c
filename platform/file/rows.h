/* rows.h: the rows of a picture on their way into a file. */
#ifndef RF_FILE_ROWS_H
#define RF_FILE_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { RF_FORMAT_GRAY8 = 0x10000 }; /* beside enum refocus_format, for JPEG alone */

struct rf_rows {
    const uint8_t *top;
    ptrdiff_t stride;
    int32_t width, height;
    uint32_t format; /* enum refocus_format; NONE: 16-bit grey */
};

/* Bytes that one pixel of enum refocus_format takes; 0 for an unknown format. This library does
 * not link the core for it. */
int rf_format_bytes(uint32_t format);
/* Whether rows of so many bytes can lie so far apart, and the offset of each row is a ptrdiff_t;
 * rows >= 1. */
bool rf_good_rows(ptrdiff_t stride, int64_t bytes, int64_t rows);

#endif
