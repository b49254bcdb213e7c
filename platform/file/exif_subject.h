/* exif_subject.h: the place of the subject by EXIF, and where that is in the upright picture. */
#ifndef RF_FILE_EXIF_SUBJECT_H
#define RF_FILE_EXIF_SUBJECT_H

#include "exif_block.h"
#include "reading.h"

enum { RF_EXIF_SUBJECT_AREA = 0x9214, RF_EXIF_SUBJECT_LOCATION = 0xa214 };

/* The point and its sides, if the entries say both. */
void rf_subject_read(const struct rf_tiff *tiff, const struct rf_tiff_entry *area,
                     const struct rf_tiff_entry *width, const struct rf_tiff_entry *height,
                     struct rf_subject *subject);
/* Turn area and location in the directory of settings with the picture, whose sides are the stored
 * ones; without these, both entries are dropped. */
void rf_subject_turn(struct rf_tiff *tiff, size_t directory, const struct rf_subject *subject);
/* Take the point for the focus of the upright photo, if nothing else said one. */
void rf_subject_settle(struct rf_read *read);

#endif
