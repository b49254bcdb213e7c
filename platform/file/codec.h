/* codec.h: a picture format whose library is a module of its own, loaded when such a file is met.
 * The module is made of this header, reading.h and the few files in codec_sources; the rest of
 * this folder is on the other side. */
#ifndef RF_FILE_CODEC_H
#define RF_FILE_CODEC_H

#include "bytes.h"
#include "reading.h"
#include "rows.h"

/* Blocks beside the pixels. Of a file that is read they are copies which the reader of formats
 * frees; of one that is written, somebody else's. */
struct rf_extras {
    struct refocus_blob exif; /* TIFF block, without "Exif\0\0" */
    struct refocus_blob icc, xmp;
    bool upright; /* the picture was turned by the library: EXIF's orientation is history */
};

/* A module exports one, `const struct rf_codec rf_codec_NAME`. */
struct rf_codec {
    const char *version; /* RF_CODEC_VERSION: a module of another release is not used */
    /* Fill read->image or read->samples, facts of the info, and the extras. */
    int (*read)(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras);
    /* Make a whole file, which free() ends; NULL: it is not written. */
    int (*write)(struct refocus_blob *file, const struct rf_rows *rows,
                 const struct rf_extras *extras, struct refocus_reason *reason);
};

#endif
