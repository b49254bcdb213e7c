/* jpeg_segments.h: segments of a JPEG are written. */
#ifndef RF_FILE_JPEG_SEGMENTS_H
#define RF_FILE_JPEG_SEGMENTS_H

#include "bytes.h"
#include "store.h"

/* Payload of a segment: 65535 less the 2 bytes of its length. */
enum { RF_JPEG_SEGMENT_MAX = 65533 };
enum {
    RF_JPEG_APP0 = 0xe0,
    RF_JPEG_APP1 = 0xe1,
    RF_JPEG_APP2 = 0xe2,
    RF_JPEG_APP13 = 0xed,
    RF_JPEG_APP14 = 0xee
};
enum { RF_JPEG_APP15 = 0xef, RF_JPEG_COM = 0xfe, RF_JPEG_SOS = 0xda };

/* The payload is the head and then the body, within RF_JPEG_SEGMENT_MAX in sum. */
void rf_jpeg_put_segment(struct rf_store *store, int marker, const void *head, size_t head_size,
                         const void *body, size_t size);
/* Bytes of a standard XMP packet that fit into a segment. */
size_t rf_jpeg_xmp_most(void);
void rf_jpeg_put_xmp(struct rf_store *store, struct rf_bytes packet);
/* An extended XMP packet of at most 4 GiB, in chunks that bear its GUID. */
void rf_jpeg_put_extended(struct rf_store *store, struct rf_bytes packet, const char guid[33]);

#endif
