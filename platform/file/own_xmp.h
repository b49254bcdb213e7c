/* own_xmp.h: the beginning of the XMP packets that this library writes, by which it finds them
 * again. */
#ifndef RF_FILE_OWN_XMP_H
#define RF_FILE_OWN_XMP_H

#include <stdbool.h>
#include "bytes.h"

#define RF_XMP_OPENING "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\" x:xmptk=\"librefocus\">"
/* Whether a standard packet is one of ours. */
bool rf_xmp_is_ours(struct rf_bytes packet);

#endif
