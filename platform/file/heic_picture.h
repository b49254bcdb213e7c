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

/* Decodes a picture as R, G, B, or the samples of an auxiliary image as they are. */
int rf_heic_decode(struct rf_heic *heic, struct heif_image_handle *handle, bool colour,
                   struct rf_raster *raster);

/* Reads the auxiliary depth image, if there is one that says which end is near. */
int rf_heic_depth(struct rf_heic *heic);

#endif
