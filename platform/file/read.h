/* read.h: the two halves of a reading, between which depth_file.c chooses what is depth. */
#ifndef RF_FILE_READ_H
#define RF_FILE_READ_H

#include "bytes.h"
#include "reading.h"

/* The public photo and what is freed with it, whatever the caller did to the fields. */
struct rf_photo {
    struct refocus_photo shown;
    void *image, *depth, *exif, *icc;
};

/* Read the file, or the second picture of a stereo file. The info must be zero and stay where it
 * is. */
int rf_read_begin(struct rf_read *read, struct rf_bytes file,
                  const struct refocus_read_limits *limits, bool picture_always, bool second,
                  struct refocus_photo_info *info, struct refocus_reason *reason);
/* Turn everything upright and hand it over, or, when status is an error, free it; returns the
 * status. */
int rf_read_finish(struct rf_read *read, int status, struct rf_photo **photo);

#endif
