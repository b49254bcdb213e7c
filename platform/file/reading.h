/* reading.h: the state of one reading, and the limits that every reader keeps. */
#ifndef RF_FILE_READING_H
#define RF_FILE_READING_H

#include <refocus/platform/file.h>
#include "bytes.h"
#include "raster.h"

struct rf_gain_map;

/* Bytes of the file for pictures that are made from the photo, see kept.c. */
enum rf_kept_kind { RF_KEPT_NOTHING, RF_KEPT_JPEG, RF_KEPT_PNG, RF_KEPT_XMP };
struct rf_kept {
    enum rf_kept_kind kind;
    struct refocus_blob bytes; /* owned */
    bool gain_map;             /* the file has one, outside of these bytes or in them */
    bool matte;                /* the photo's was given to an earlier result, see editable.c */
    /* EXIF orientations by which the original and the depth in these bytes lie: */
    int original_orientation, depth_orientation;
};

/* The picture of a file that is meant: its photo, or one of a stereo file. */
enum rf_view { RF_VIEW_PHOTO, RF_VIEW_FIRST, RF_VIEW_SECOND };

/* The middle of the subject by EXIF. The sides and the point are those of the camera's pixels. */
struct rf_subject {
    double x, y;            /* fractions of the sides; x -1: not said */
    uint32_t width, height; /* 0: not said */
    int orientation;        /* EXIF 1 to 8, before the block was made upright */
    int held;               /* the orientation by which the phone was held, of a picture that is
                               turned onto its side; 0: not known */
};

/* Readers of formats fill it, and read.c turns it into a photo. */
struct rf_read {
    struct refocus_read_limits limits; /* no zeros */
    struct refocus_reason *reason;     /* never NULL */
    bool picture_always;               /* false: the main picture only when there is no depth */
    struct refocus_photo_info *info;
    struct refocus_blob exif, icc; /* owned */
    struct rf_kept kept;
    size_t file_bytes;           /* size of the file in memory */
    struct rf_raster image;      /* as stored */
    struct rf_raster deep;       /* image of 16 bits or floats, once `image` is of 8 bits */
    struct rf_raster samples;    /* depth, as stored */
    struct rf_raster matte;      /* white is subject */
    struct rf_raster confidence; /* for each sample: 255 is sure, 0 a guess */
    struct rf_raster holes;      /* for each pixel of an image that is read for its depth: 0 where
                                    it is transparent, which is no distance */
    struct refocus_depth_map depth; /* meaning, values and range of the samples */
    int orientation;                /* 1 to 8, to be applied to image, samples and gain map */
    struct rf_gain_map *gain;       /* NULL: no gain map is asked for */
    double apple_headroom;          /* by an iPhone's EXIF; 0: not said */
    struct rf_subject subject;
    /* Gain map and portrait matte of a JPEG, behind its main picture in the file. */
    struct rf_bytes companion[2];
    int companions;
    enum rf_view view;
};

/* Sizes are checked here and nowhere else, in 64 bits and before memory is asked for: sides are
 * at least 1, sides, pixels and bytes within the limits. */
int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height,
                  uint64_t pixel_bytes);
int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what);
int rf_check_metadata(const struct rf_read *read, uint64_t bytes, const char *what);
/* Whether so many more bytes fit beside the file and the pictures that there are. */
int rf_check_memory(const struct rf_read *read, uint64_t more);
/* Memory for a raster whose other fields are filled, within the limits. */
int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster);
/* Whether transparency is of use: it says where a depth map has no value. */
bool rf_wants_alpha(const struct rf_read *read);
/* Take the last of 2 or 4 channels out of read->image, and into read->holes where it is 0 anywhere.
 */
int rf_part_alpha(struct rf_read *read);

#endif
