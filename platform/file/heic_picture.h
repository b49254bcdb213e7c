/* heic_picture.h: what reading any part of a HEIC needs: its handles, decoding, errors. */
#ifndef RF_FILE_HEIC_PICTURE_H
#define RF_FILE_HEIC_PICTURE_H

#include <libheif/heif.h>
#include "bytes.h"
#include "raster.h"
#include "reading.h"

struct rf_heic {
    struct rf_read *read;
    struct rf_bytes file;
    struct heif_context *context;
    struct heif_image_handle *primary;
    struct heif_decoding_options *options;
};

/* The error of ours for one of libheif, and its words as the reason. */
int rf_heic_fail(const struct rf_read *read, struct heif_error error);

/* A context with the limits; NULL: not enough memory. */
struct heif_context *rf_heic_context(const struct refocus_read_limits *limits);

/* How a picture is decoded: the samples of an auxiliary image as they are, or R, G, B of all its
 * bits, or of 8. */
enum rf_heic_form { RF_HEIC_SAMPLES, RF_HEIC_COLOUR, RF_HEIC_COLOUR_8 };
int rf_heic_decode(struct rf_heic *heic, struct heif_image_handle *handle, enum rf_heic_form form,
                   struct rf_raster *raster);

/* Reads the auxiliary depth image, if there is one that says which end is near. */
int rf_heic_depth(struct rf_heic *heic);

#endif
