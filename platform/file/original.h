/* original.h: the all-in-focus original that an editable result holds. */
#ifndef RF_FILE_ORIGINAL_H
#define RF_FILE_ORIGINAL_H

#include "text.h"
#include <refocus/platform/file.h>

/* Put the file of a photo, with its gain map and portrait matte, at the end of `out`, which may
 * have failed then. *is_png: it is one, else a JPEG. */
int rf_original_put(struct rf_text *out, const struct refocus_photo *photo, bool *is_png,
                    struct refocus_reason *reason);

#endif
