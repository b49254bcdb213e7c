/* png_chunks.c: the chunks of a PNG are gone through, and kept for pictures that are made from it.
 * A chunk is its length, four letters, its content and a checksum. */
#include "png_chunks.h"

#include <stdlib.h>
#include <string.h>

#include "reason.h"

enum { SIGNATURE = 8, AROUND = 12, LOWER_CASE = 0x20 };

/* Keyword, no compression, no language, no translated keyword. */
const char rf_png_xmp_head[RF_PNG_XMP_HEAD] = "XML:com.adobe.xmp\0\0\0\0";

bool rf_png_next_chunk(struct rf_bytes *rest, struct rf_png_chunk *chunk)
{
    const uint8_t *const b = rest->data;
    size_t size;

    if (rest->size < AROUND)
        return false;
    size = rf_big_endian(b, 4);
    if (size > rest->size - AROUND)
        return false;
    chunk->type = b + 4;
    chunk->content = (struct rf_bytes){b + 8, size};
    rest->data += size + AROUND;
    rest->size -= size + AROUND;
    return true;
}

static bool is_one_of(const uint8_t *type, const char *types)
{
    for (; *types; types += 4)
        if (memcmp(type, types, 4) == 0)
            return true;
    return false;
}

/* Colours of a picture that was read as light are sRGB when it is written.
 * Chunks that nobody here knows say by their fourth letter whether they hold for other pixels. */
static bool holds(const struct rf_png_chunk *chunk, bool is_light)
{
    if (is_light && is_one_of(chunk->type, "sRGBgAMAcHRMcICPmDCVmDCvcLLIcLLi"))
        return false;
    return is_one_of(chunk->type, "tEXtzTXtiTXttIMEpHYssRGBgAMAcHRMcICPmDCVcLLIoFFssCALpCAL") ||
           (chunk->type[0] & LOWER_CASE && chunk->type[3] & LOWER_CASE &&
            !is_one_of(chunk->type, "eXIfiCCPbKGDhISTtRNSsBITacTLfcTLfdAT"));
}

/* Bytes of the chunks that hold, copied to `out` unless that is NULL. */
static size_t gather(struct rf_bytes file, bool is_light, uint8_t *out)
{
    struct rf_bytes rest = {file.data + SIGNATURE, file.size - SIGNATURE};
    struct rf_png_chunk chunk;
    size_t size = 0;

    while (rf_png_next_chunk(&rest, &chunk)) {
        if (holds(&chunk, is_light)) {
            const size_t n = chunk.content.size + AROUND;

            if (out)
                memcpy(out + size, chunk.content.data - 8, n);
            size += n;
        }
    }
    return size;
}

int rf_png_keep(struct rf_read *read, struct rf_bytes file)
{
    const bool is_light = read->image.sample == REFOCUS_SAMPLE_F32;
    const size_t size = gather(file, is_light, NULL);
    int status;

    if (!read->picture_always || size == 0)
        return REFOCUS_OK;
    status = rf_check_memory(read, size);
    if (status != REFOCUS_OK)
        return status;
    read->kept.bytes.data = malloc(size);
    if (!read->kept.bytes.data)
        return rf_fail_memory(read->reason);
    gather(file, is_light, read->kept.bytes.data);
    read->kept.bytes.size = size;
    read->kept.kind = RF_KEPT_PNG;
    return REFOCUS_OK;
}

struct rf_bytes rf_png_xmp_of(const struct rf_png_chunk *chunk)
{
    const struct rf_bytes text = chunk->content;

    if (memcmp(chunk->type, "iTXt", 4) != 0 || text.size < RF_PNG_XMP_HEAD ||
        memcmp(text.data, rf_png_xmp_head, RF_PNG_XMP_HEAD) != 0)
        return (struct rf_bytes){NULL, 0};
    return (struct rf_bytes){text.data + RF_PNG_XMP_HEAD, text.size - RF_PNG_XMP_HEAD};
}

struct rf_bytes rf_png_xmp(struct rf_bytes chunks)
{
    struct rf_bytes packet = {NULL, 0};
    struct rf_png_chunk chunk;

    while (packet.size == 0 && rf_png_next_chunk(&chunks, &chunk))
        packet = rf_png_xmp_of(&chunk);
    return packet;
}
