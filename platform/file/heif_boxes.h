/* heif_boxes.h: the boxes of a HEIF container, for what libheif does not tell. All that is found
 * lies in the file's bytes. */
#ifndef RF_FILE_HEIF_BOXES_H
#define RF_FILE_HEIF_BOXES_H

#include <stdbool.h>
#include "bytes.h"

struct rf_heif_box {
    char type[5];
    struct rf_bytes content;
};

/* Take bytes, which are there, off the front. */
void rf_heif_skip(struct rf_bytes *bytes, size_t size);
/* Take the next box off the front; false at the end and where no box begins. */
bool rf_heif_next(struct rf_bytes *rest, struct rf_heif_box *box);
/* The first box of a type. */
bool rf_heif_find(struct rf_bytes rest, const char *type, struct rf_bytes *content);
/* The boxes that describe the file's items. */
bool rf_heif_meta(struct rf_bytes file, struct rf_bytes *boxes);
/* The bytes in them that hold the number of the main picture, two or four. */
bool rf_heif_primary(struct rf_bytes meta, struct rf_bytes *number);

/* The numbers of two pictures that are said to be a stereo pair, the left one first (ISO/IEC
 * 23008-12, 6.8.7), and not of a burst. */
bool rf_heif_stereo_pair(struct rf_bytes file, uint32_t pair[2]);
/* Whether the file holds tracks alone, and no picture. */
bool rf_heif_is_sequence(struct rf_bytes file);

#endif
