/* heif_boxes.h: what a HEIF container states that libheif does not tell. */
#ifndef RF_FILE_HEIF_BOXES_H
#define RF_FILE_HEIF_BOXES_H

#include <stdbool.h>
#include "bytes.h"

/* EXIF's number for the rotation and mirroring of an item; item 0 is the main picture. 1 when the
 * container states none. */
int rf_heif_orientation(struct rf_bytes file, uint32_t item);
/* Whether two pictures are said to be a stereo pair (ISO/IEC 23008-12, 6.8.7), not of a burst. */
bool rf_heif_is_stereo(struct rf_bytes file);
/* Whether the file holds tracks alone, and no picture. */
bool rf_heif_is_sequence(struct rf_bytes file);

#endif
