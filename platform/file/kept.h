/* kept.h: bytes of a file that a picture made from it keeps. */
#ifndef RF_FILE_KEPT_H
#define RF_FILE_KEPT_H

#include "bytes.h"
#include "reading.h"
#include "xmp_keep.h"

/* Copy such bytes at the end of a reading, when there is a photo to be; of a JPEG its companions,
 * too. */
int rf_keep(struct rf_read *read, enum rf_kept_kind kind, struct rf_bytes bytes);
/* Have a picture that was read from behind the main one kept behind it. */
void rf_keep_companion(struct rf_read *read, struct rf_bytes picture);

/* The parts of a photo that refocus_photo_read() made which only the writers see. */
const struct rf_kept *rf_kept_of(const struct refocus_photo *photo);
/* Edit the XMP of a photo, or of none, for a picture of this size. The rest of *keep is zeros but
 * for `cut`, `insert` and `insert_extended`; rf_xmp_keep_free() ends it, whatever is returned. */
int rf_keep_xmp(const struct refocus_photo *photo, struct rf_xmp_keep *keep, int32_t width,
                int32_t height, struct refocus_reason *reason);
/* Say what else of the photo's file only its own kind holds and a file of that kind does not. */
void rf_keep_warn_kind(const struct refocus_photo *photo, enum rf_kept_kind written,
                       struct refocus_reason *reason);
/* Say that the photo's gain map is left out, if it has one. */
void rf_keep_warn(const struct refocus_photo *photo, const struct rf_xmp_keep *keep,
                  struct refocus_reason *reason);

#endif
