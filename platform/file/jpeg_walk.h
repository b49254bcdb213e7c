/* jpeg_walk.h: the segments of a JPEG, one after another. */
#ifndef RF_FILE_JPEG_WALK_H
#define RF_FILE_JPEG_WALK_H

#include <stdbool.h>
#include "bytes.h"

enum rf_jpeg_step { RF_JPEG_SEGMENT, RF_JPEG_END, RF_JPEG_DAMAGED };
struct rf_jpeg_walk {
    struct rf_bytes file;
    size_t position; /* at RF_JPEG_END: the byte behind the picture */
    int marker;      /* second byte, 0xE1 for APP1 */
    struct rf_bytes segment;
};

bool rf_is_jpeg(struct rf_bytes file);
/* Begin at a file's SOI. */
bool rf_jpeg_walk_begin(struct rf_jpeg_walk *walk, struct rf_bytes file);
/* Go to the next segment with a length; entropy-coded data is skipped. */
enum rf_jpeg_step rf_jpeg_walk_next(struct rf_jpeg_walk *walk);
/* The bytes behind a signature at the begin of a segment; false when it is not there. */
bool rf_jpeg_after(struct rf_bytes segment, const char *signature, size_t size,
                   struct rf_bytes *rest);
extern const char rf_jpeg_exif_signature[6];
extern const char rf_jpeg_icc_signature[12];
extern const char rf_jpeg_xmp_signature[29];
extern const char rf_jpeg_extended_signature[35];
extern const char rf_jpeg_mpf_signature[4];
extern const char rf_jpeg_gain_signature[28];

#endif
