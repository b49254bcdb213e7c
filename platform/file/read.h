/* read.h: the two halves of a reading, between which depth_file.c chooses what is depth. */
#ifndef RF_FILE_READ_H
#define RF_FILE_READ_H

#include "bytes.h"
#include "reading.h"

/* The public photo, its parts, and what is freed with it, whatever the caller did to the fields. */
struct rf_photo {
    struct refocus_photo shown;
    struct refocus_image image;
    struct refocus_depth_map depth;
    struct refocus_photo_info info;
    void *pixels, *samples, *exif, *icc;
};

/* The limits of a reading: the given ones, if any, and in place of zeros the defaults. */
int rf_read_limits(struct refocus_read_limits *limits, const struct refocus_read_limits *given,
                   struct refocus_reason *reason);
/* A photo of nothing yet; NULL without memory. */
struct rf_photo *rf_photo_new(void);

/* Read the file, or the second picture of a stereo file. The info must be new and stay where it
 * is. */
int rf_read_begin(struct rf_read *read, struct rf_bytes file,
                  const struct refocus_read_limits *limits, bool picture_always, bool second,
                  struct refocus_photo_info *info, struct refocus_reason *reason);
/* Turn everything upright and hand it over, or, when status is an error, free it; returns the
 * status. */
int rf_read_finish(struct rf_read *read, int status, struct rf_photo **photo);

#endif
