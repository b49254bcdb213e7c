/* png_format.h: how a PNG is recognised. */
#ifndef RF_FILE_PNG_FORMAT_H
#define RF_FILE_PNG_FORMAT_H

#include <stdbool.h>
#include "bytes.h"

bool rf_is_png(struct rf_bytes file);

#endif
