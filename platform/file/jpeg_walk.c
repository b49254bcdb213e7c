/* jpeg_walk.c: a JPEG is gone through segment by segment, from SOI to EOI. */
#include "jpeg_walk.h"

#include <string.h>

const char rf_jpeg_exif_signature[6] = "Exif\0";
const char rf_jpeg_icc_signature[12] = "ICC_PROFILE";
const char rf_jpeg_xmp_signature[29] = "http://ns.adobe.com/xap/1.0/";
const char rf_jpeg_extended_signature[35] = "http://ns.adobe.com/xmp/extension/";
const char rf_jpeg_mpf_signature[4] = "MPF";
const char rf_jpeg_gain_signature[28] = "urn:iso:std:iso:ts:21496:-1";

enum { MARKER_TEM = 0x01, MARKER_RST0 = 0xd0, MARKER_RST7 = 0xd7 };
enum { MARKER_SOI = 0xd8, MARKER_EOI = 0xd9 };

bool rf_is_jpeg(struct rf_bytes file)
{
    return file.size >= 3 && memcmp(file.data, "\xff\xd8\xff", 3) == 0;
}

bool rf_jpeg_walk_begin(struct rf_jpeg_walk *walk, struct rf_bytes file)
{
    memset(walk, 0, sizeof *walk);
    walk->file = file;
    walk->position = 2;
    return file.size >= 4 && file.data[0] == 0xff && file.data[1] == MARKER_SOI;
}

/* Go to the byte behind the next marker, over entropy-coded data and fill bytes; 0 at the end of
 * the file. */
static int next_marker(struct rf_jpeg_walk *walk)
{
    const uint8_t *const data = walk->file.data;
    const size_t size = walk->file.size;

    while (walk->position < size) {
        const uint8_t *const found = memchr(data + walk->position, 0xff, size - walk->position);
        if (!found)
            return 0;
        walk->position = (size_t)(found - data);
        while (walk->position < size && data[walk->position] == 0xff)
            walk->position++;
        if (walk->position < size && data[walk->position] != 0)
            return data[walk->position++];
    }
    return 0;
}

enum rf_jpeg_step rf_jpeg_walk_next(struct rf_jpeg_walk *walk)
{
    size_t room, length;

    do {
        walk->marker = next_marker(walk);
    } while (walk->marker == MARKER_TEM ||
             (walk->marker >= MARKER_RST0 && walk->marker <= MARKER_RST7));
    if (walk->marker == MARKER_EOI)
        return RF_JPEG_END;
    room = walk->file.size - walk->position;
    if (walk->marker == 0 || walk->marker == MARKER_SOI || room < 2)
        return RF_JPEG_DAMAGED;
    length = (size_t)walk->file.data[walk->position] << 8 | walk->file.data[walk->position + 1];
    if (length < 2 || length > room)
        return RF_JPEG_DAMAGED;
    walk->segment.data = walk->file.data + walk->position + 2;
    walk->segment.size = length - 2;
    walk->position += length;
    return RF_JPEG_SEGMENT;
}

bool rf_jpeg_after(struct rf_bytes segment, const char *signature, size_t size,
                   struct rf_bytes *rest)
{
    if (segment.size < size || memcmp(segment.data, signature, size) != 0)
        return false;
    rest->data = segment.data + size;
    rest->size = segment.size - size;
    return true;
}
