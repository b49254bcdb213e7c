/* reading.h: the state of one reading, and the limits that every reader keeps. */
#ifndef RF_FILE_READING_H
#define RF_FILE_READING_H

#include <refocus/platform/file.h>
#include "raster.h"

/* Readers of formats fill it, and read.c turns it into a photo. */
struct rf_read {
    struct refocus_read_limits limits; /* no zeros */
    struct refocus_reason *reason;     /* never NULL */
    bool picture_always;               /* false: the main picture only when there is no depth */
    struct refocus_photo_info *info;
    struct refocus_blob exif, icc;  /* owned */
    struct rf_raster image;         /* as stored */
    struct rf_raster samples;       /* depth, as stored */
    struct refocus_depth_map depth; /* meaning, values and range of the samples */
    int orientation;                /* 1 to 8, to be applied to image and samples */
    bool second;                    /* the second picture of a stereo file is meant */
};

/* Sizes are checked here and nowhere else, in 64 bits and before memory is asked for: sides are
 * 1 to REFOCUS_MAX_SIDE, pixels and bytes within the limits. */
int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height,
                  uint64_t pixel_bytes);
int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what);
/* Memory for a raster whose other fields are filled, within the limits. */
int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster);

#endif
