/* read.h: the two halves of a reading, between which depth_file.c chooses what is depth. */
#ifndef RF_FILE_READ_H
#define RF_FILE_READ_H

#include "bytes.h"
#include "gain_map.h"
#include "reading.h"

/* The public photo, its parts, and what is freed with it, whatever the caller did to the fields. */
struct rf_photo {
    struct refocus_photo shown;
    struct refocus_image image, deep;
    struct refocus_depth_map depth, matte;
    struct refocus_photo_info info;
    struct rf_gain_map gain;
    void *pixels, *deep_pixels, *samples, *confidence, *matte_samples, *exif, *icc;
    struct rf_kept kept;
    struct refocus_read_limits limits; /* kept by its reading */
};

/* The limits of a reading: the given ones, if any, and in place of zeros the defaults. */
int rf_read_limits(struct refocus_read_limits *limits, const struct refocus_read_limits *given,
                   struct refocus_reason *reason);
/* A photo of nothing yet; NULL without memory. */
struct rf_photo *rf_photo_new(void);

/* Read a picture of the file. The info must be new and stay where it
 * is, and so must the place for a gain map, which may be NULL: none is wanted. */
int rf_read_begin(struct rf_read *read, struct rf_bytes file,
                  const struct refocus_read_limits *limits, bool picture_always, enum rf_view view,
                  struct refocus_photo_info *info, struct rf_gain_map *gain,
                  struct refocus_reason *reason);
/* Turn everything upright and hand it over, or, when status is an error, free it; returns the
 * status. */
int rf_read_finish(struct rf_read *read, int status, struct rf_photo **photo);

#endif
