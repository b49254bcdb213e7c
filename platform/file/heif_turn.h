/* heif_turn.h: how a HEIF container turns its pictures. */
#ifndef RF_FILE_HEIF_TURN_H
#define RF_FILE_HEIF_TURN_H

#include "bytes.h"

/* EXIF's number for the rotation and mirroring of an item; item 0 is the main picture. 1 when the
 * container states none. */
int rf_heif_orientation(struct rf_bytes file, uint32_t item);

#endif
