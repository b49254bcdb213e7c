/* xmp_extended.c: an extended XMP packet, too large for one segment, is put together from chunks
 * that name the packet's GUID, its length and their place in it (XMP specification part 3,
 * 1.1.3.1). */
#include "xmp_extended.h"

#include <stdlib.h>
#include <string.h>

#include "jpeg_walk.h"
#include "reason.h"

enum { GUID_BYTES = 32, HEAD_BYTES = GUID_BYTES + 8 };

struct chunk {
    uint64_t length, offset; /* length of the packet; offset of this chunk in it */
    struct rf_bytes content;
};

/* Find the walk's next chunk with this GUID; others are counted as strangers. */
static bool next_chunk(struct rf_jpeg_walk *walk, const char *guid, struct chunk *chunk,
                       int *strangers)
{
    struct rf_bytes rest;

    while (rf_jpeg_walk_next(walk) == RF_JPEG_SEGMENT) {
        if (walk->marker != 0xe1 ||
            !rf_jpeg_after(walk->segment, rf_jpeg_extended_signature,
                           sizeof rf_jpeg_extended_signature, &rest) ||
            rest.size < HEAD_BYTES)
            continue;
        if (memcmp(rest.data, guid, GUID_BYTES) != 0) {
            ++*strangers;
            continue;
        }
        chunk->length = rf_big_endian(rest.data + GUID_BYTES, 4);
        chunk->offset = rf_big_endian(rest.data + GUID_BYTES + 4, 4);
        chunk->content.data = rest.data + HEAD_BYTES;
        chunk->content.size = rest.size - HEAD_BYTES;
        return true;
    }
    return false;
}

static int fail_chunks(const struct rf_read *read, const char *why)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: its extended XMP, which holds the depth, %s; copy the file "
                   "again from the phone",
                   why);
}

struct place {
    uint64_t offset;
    uint64_t size;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *const first = a, *const second = b;

    return first->offset < second->offset ? -1 : first->offset > second->offset;
}

/* Chunks must lie one after another, without gap and overlap, up to the length. */
static int check_places(const struct rf_read *read, struct place *places, size_t count,
                        uint64_t length)
{
    uint64_t reached = 0;

    qsort(places, count, sizeof *places, compare_places);
    for (size_t i = 0; i < count; i++) {
        if (places[i].offset < reached)
            return fail_chunks(read, "has parts that overlap");
        if (places[i].offset > reached)
            return fail_chunks(read, "lacks a part");
        reached += places[i].size;
    }
    return reached == length ? REFOCUS_OK : fail_chunks(read, "lacks a part");
}

/* Find the number of chunks and the packet's length, in which all chunks must agree. */
static int survey(struct rf_read *read, struct rf_bytes jpeg, const char *guid, size_t *count,
                  uint64_t *length)
{
    struct rf_jpeg_walk walk;
    struct chunk chunk;
    int strangers = 0;

    *count = 0;
    *length = 0;
    rf_jpeg_walk_begin(&walk, jpeg);
    while (next_chunk(&walk, guid, &chunk, &strangers)) {
        if (++*count == 1)
            *length = chunk.length;
        if (chunk.length != *length || chunk.offset > *length ||
            chunk.content.size > *length - chunk.offset)
            return fail_chunks(read, "contradicts itself");
    }
    if (strangers > 0)
        rf_note(read->info, "XMP: %d extended parts of another GUID passed over", strangers);
    if (*count == 0)
        return fail_chunks(read, "is missing");
    return rf_check_metadata(read, *length, "its extended XMP");
}

int rf_xmp_extended(struct rf_read *read, struct rf_bytes jpeg, const char *guid,
                    size_t guid_length, struct refocus_blob *packet)
{
    struct place *places = NULL;
    struct rf_jpeg_walk walk;
    struct chunk chunk;
    uint64_t length;
    size_t count, n = 0;
    int strangers = 0;
    int status;

    packet->data = NULL;
    packet->size = 0;
    if (guid_length != GUID_BYTES)
        return fail_chunks(read, "is named by no proper GUID");
    status = survey(read, jpeg, guid, &count, &length);
    if (status != REFOCUS_OK)
        return status;
    places = malloc(count * sizeof *places);
    if (!places)
        return rf_fail_memory(read->reason);
    rf_jpeg_walk_begin(&walk, jpeg);
    while (n < count && next_chunk(&walk, guid, &chunk, &strangers)) {
        places[n].offset = chunk.offset;
        places[n++].size = chunk.content.size;
    }
    status = check_places(read, places, n, length);
    free(places);
    if (status != REFOCUS_OK)
        return status;
    packet->data = malloc((size_t)length + 1);
    if (!packet->data)
        return rf_fail_memory(read->reason);
    packet->size = (size_t)length;
    rf_jpeg_walk_begin(&walk, jpeg);
    while (next_chunk(&walk, guid, &chunk, &strangers))
        memcpy(packet->data + chunk.offset, chunk.content.data, chunk.content.size);
    rf_note(read->info, "XMP: extended packet of %llu bytes in %zu parts, complete",
            (unsigned long long)length, count);
    return REFOCUS_OK;
}
