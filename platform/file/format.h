/* format.h: what a picture format is to this library, and the list of all formats. */
#ifndef RF_FILE_FORMAT_H
#define RF_FILE_FORMAT_H

#include "bytes.h"
#include "reading.h"
#include "rows.h"
#include "store.h"

struct rf_format {
    const char *name;       /* as refocus_file_formats() lists it */
    const char *library;    /* library that a build needs to read it; NULL: nothing */
    const char *endings[3]; /* endings of names under which it is written, NULL behind the last */
    bool writes_pictures, writes_depth;
    bool has_second; /* a file can hold the second picture of a stereo pair */
    uint32_t deep;   /* the deep enum refocus_format that it is written from; 0: none */
    /* Whether a file begins as this format does. */
    bool (*recognise)(struct rf_bytes file);
    /* Fill read->image, or read->samples, and what the file says of itself. NULL: the library is
     * missing. */
    int (*read)(struct rf_read *read, struct rf_bytes file);
    /* NULL: it is not written, or the library is missing. */
    int (*write)(struct rf_store *store, const struct rf_rows *rows,
                 const struct refocus_write_options *options, struct refocus_reason *reason);
};

/* Each line is one format: rf_format_NAME is defined in the file that reads or describes it. In
 * this order files are recognised and endings are listed. */
#define RF_FORMAT_LIST(FORMAT)                                                                     \
    FORMAT(jpeg)                                                                                   \
    FORMAT(png)                                                                                    \
    FORMAT(heic)                                                                                   \
    FORMAT(raw)                                                                                    \
    FORMAT(tiff)                                                                                   \
    FORMAT(openexr)                                                                                \
    FORMAT(webp)                                                                                   \
    FORMAT(jxl)                                                                                    \
    FORMAT(npy)                                                                                    \
    FORMAT(npz)                                                                                    \
    FORMAT(ppm)                                                                                    \
    FORMAT(pgm)                                                                                    \
    FORMAT(pfm)

#define RF_DECLARE_FORMAT(name) extern const struct rf_format rf_format_##name;
RF_FORMAT_LIST(RF_DECLARE_FORMAT)
#undef RF_DECLARE_FORMAT

#endif
