/* exif_copy.h: what a TIFF says of the camera becomes an EXIF block, and goes from one into a TIFF.
 */
#ifndef RF_FILE_EXIF_COPY_H
#define RF_FILE_EXIF_COPY_H

#include <stdbool.h>

#include "bytes.h"

/* Bytes that are enough for either; entries beyond them are left out, as are values of more than 16
 * KiB. A block of this size fits into a JPEG. */
enum { RF_EXIF_COPY_ROOM = 65000 };

/* Make an EXIF block of a TIFF, or of a camera raw that is one: of its first directory what EXIF
 * shares, the camera's settings without the maker's note, whose offsets would be wrong, and the
 * place. Returns its bytes; 0: there are none. */
size_t rf_exif_of_tiff(struct rf_bytes tiff, uint8_t *to);

/* The directory of settings (0x8769) or of the place (0x8825) of an EXIF block for a file of the
 * same byte order in which it begins at `base`. Returns its bytes; 0: there is none. */
size_t rf_exif_directory(struct rf_bytes exif, uint32_t tag, uint32_t base, uint8_t *to);

/* Whether it has a maker's note, which copies lack. */
bool rf_exif_has_maker_note(struct rf_bytes exif);

/* A text of the main directory, cut to the room; false: there is none. */
bool rf_exif_text(struct rf_bytes exif, uint32_t tag, char *to, size_t room);

#endif
