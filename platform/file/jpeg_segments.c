/* jpeg_segments.c: segments of a JPEG are written; an extended XMP packet takes several (XMP
 * specification part 3, 1.1.3.1). */
#include "jpeg_segments.h"

#include <string.h>

#include "jpeg_walk.h"

enum { CHUNK = 65000, GUID_BYTES = 32 };

void rf_jpeg_put_segment(struct rf_store *store, int marker, const void *head, size_t head_size,
                         const void *body, size_t size)
{
    const size_t length = head_size + size + 2;
    const uint8_t begin[4] = {0xff, (uint8_t)marker, (uint8_t)(length >> 8), (uint8_t)length};

    rf_store_write(store, begin, sizeof begin);
    rf_store_write(store, head, head_size);
    rf_store_write(store, body, size);
}

size_t rf_jpeg_xmp_most(void)
{
    return RF_JPEG_SEGMENT_MAX - sizeof rf_jpeg_xmp_signature;
}

void rf_jpeg_put_xmp(struct rf_store *store, struct rf_bytes packet)
{
    rf_jpeg_put_segment(store, RF_JPEG_APP1, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature,
                        packet.data, packet.size);
}

void rf_jpeg_put_extended(struct rf_store *store, struct rf_bytes packet, const char guid[33])
{
    uint8_t head[sizeof rf_jpeg_extended_signature + GUID_BYTES + 8];
    uint8_t *const numbers = head + sizeof rf_jpeg_extended_signature + GUID_BYTES;

    memcpy(head, rf_jpeg_extended_signature, sizeof rf_jpeg_extended_signature);
    memcpy(head + sizeof rf_jpeg_extended_signature, guid, GUID_BYTES);
    for (size_t at = 0; at < packet.size; at += CHUNK) {
        const size_t n = packet.size - at < CHUNK ? packet.size - at : CHUNK;

        for (int i = 0; i < 4; i++) {
            numbers[i] = (uint8_t)(packet.size >> (24 - 8 * i));
            numbers[4 + i] = (uint8_t)(at >> (24 - 8 * i));
        }
        rf_jpeg_put_segment(store, RF_JPEG_APP1, head, sizeof head, packet.data + at, n);
    }
}
