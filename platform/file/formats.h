/* formats.h: the table of picture formats, by content and by the end of a name. */
#ifndef RF_FILE_FORMATS_H
#define RF_FILE_FORMATS_H

#include "format.h"

/* The format that a file begins as; NULL for none. */
const struct rf_format *rf_format_of_content(struct rf_bytes file);
/* The format that is written under such a name; NULL for none. */
bool rf_format_is_known(struct rf_bytes file);
const struct rf_format *rf_format_of_name(const char *path);
/* Endings of the formats that are written, for pictures or for depth: ".png, .pgm or .pfm". */
void rf_list_endings(char *text, size_t size, bool depth);

#endif
