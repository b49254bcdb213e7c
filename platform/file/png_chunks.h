/* png_chunks.h: the chunks of a PNG beside its pixels. */
#ifndef RF_FILE_PNG_CHUNKS_H
#define RF_FILE_PNG_CHUNKS_H

#include <stdbool.h>
#include "bytes.h"
#include "reading.h"

struct rf_png_chunk {
    const uint8_t *type; /* 4 letters */
    struct rf_bytes content;
};

/* Take the next chunk off the front of bytes that begin with one. */
bool rf_png_next_chunk(struct rf_bytes *rest, struct rf_png_chunk *chunk);
/* Keep the chunks of a file that hold for another picture of the same colours, too. EXIF and the
 * colour profile are not among them. */
int rf_png_keep(struct rf_read *read, struct rf_bytes file);
/* The XMP packet of a chunk; empty when it is another one, or compressed. */
struct rf_bytes rf_png_xmp_of(const struct rf_png_chunk *chunk);
/* The XMP packet among chunks; empty: none. */
struct rf_bytes rf_png_xmp(struct rf_bytes chunks);
/* The content of an iTXt chunk before its XMP packet. */
enum { RF_PNG_XMP_HEAD = 22 };
extern const char rf_png_xmp_head[RF_PNG_XMP_HEAD];

#endif
