/* exif_block.c: the entries of a TIFF block are found, changed and taken out. */
#include "exif_block.h"

#include <string.h>

enum {
    TAG_STRIPS = 0x0111,
    TAG_STRIP_BYTES = 0x0117,
    TAG_THUMBNAIL = 0x0201,
    TAG_THUMBNAIL_BYTES = 0x0202,
};

uint32_t rf_tiff_get16(const struct rf_tiff *tiff, size_t at)
{
    const uint8_t *const b = tiff->data + at;

    return tiff->big_endian ? (uint32_t)(b[0] << 8 | b[1]) : (uint32_t)(b[1] << 8 | b[0]);
}

uint32_t rf_tiff_get32(const struct rf_tiff *tiff, size_t at)
{
    const uint32_t first = rf_tiff_get16(tiff, at), second = rf_tiff_get16(tiff, at + 2);

    return tiff->big_endian ? first << 16 | second : second << 16 | first;
}

void rf_tiff_put16(struct rf_tiff *tiff, size_t at, uint32_t value)
{
    tiff->data[at] = (uint8_t)(tiff->big_endian ? value >> 8 : value);
    tiff->data[at + 1] = (uint8_t)(tiff->big_endian ? value : value >> 8);
}

int rf_tiff_count(const struct rf_tiff *tiff, size_t directory)
{
    size_t room;

    if (directory > tiff->size || tiff->size - directory < 2)
        return -1;
    room = (tiff->size - directory - 2) / 12;
    return rf_tiff_get16(tiff, directory) <= room ? (int)rf_tiff_get16(tiff, directory) : (int)room;
}

bool rf_tiff_entry(const struct rf_tiff *tiff, size_t directory, int index,
                   struct rf_tiff_entry *entry)
{
    static const uint8_t type_bytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8};
    uint64_t bytes;

    entry->place = directory + 2 + (size_t)index * 12;
    entry->tag = rf_tiff_get16(tiff, entry->place);
    entry->type = rf_tiff_get16(tiff, entry->place + 2);
    entry->count = rf_tiff_get32(tiff, entry->place + 4);
    if (entry->type == 0 || entry->type > RF_TIFF_SIGNED_RATIONAL || entry->count == 0)
        return false;
    bytes = (uint64_t)entry->count * type_bytes[entry->type];
    entry->value = bytes <= 4 ? entry->place + 8 : rf_tiff_get32(tiff, entry->place + 8);
    return entry->value <= tiff->size && bytes <= tiff->size - entry->value;
}

uint32_t rf_tiff_integer(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry,
                         uint32_t index)
{
    return entry->type == RF_TIFF_SHORT  ? rf_tiff_get16(tiff, entry->value + 2 * (size_t)index)
           : entry->type == RF_TIFF_LONG ? rf_tiff_get32(tiff, entry->value + 4 * (size_t)index)
                                         : 0;
}

void rf_tiff_set_integer(struct rf_tiff *tiff, const struct rf_tiff_entry *entry, uint32_t value)
{
    if (entry->count == 1 && entry->type == RF_TIFF_LONG) {
        rf_tiff_put16(tiff, entry->value, tiff->big_endian ? value >> 16 : value & 0xffff);
        rf_tiff_put16(tiff, entry->value + 2, tiff->big_endian ? value & 0xffff : value >> 16);
    } else if (entry->count == 1 && entry->type == RF_TIFF_SHORT && value <= UINT16_MAX) {
        rf_tiff_put16(tiff, entry->value, value);
    }
}

void rf_tiff_drop(struct rf_tiff *tiff, size_t directory, uint32_t tag)
{
    int count = rf_tiff_count(tiff, directory);

    for (int i = count - 1; i >= 0; i--) {
        const size_t place = directory + 2 + (size_t)i * 12;
        const size_t behind = directory + 2 + (size_t)count * 12;
        /* The link goes with the entries. */
        const size_t end = tiff->size - behind < 4 ? behind : behind + 4;

        if (rf_tiff_get16(tiff, place) == tag) {
            memmove(tiff->data + place, tiff->data + place + 12, end - place - 12);
            memset(tiff->data + end - 12, 0, 12);
            rf_tiff_put16(tiff, directory, (uint32_t)--count);
        }
    }
}

/* Header and main directory are not erased, and no more in all than the size of the block, so that
 * places which overlap cost no more than one that is large. */
struct eraser {
    struct rf_tiff *tiff;
    size_t directory, end; /* the main directory's bytes lie between these */
    size_t budget;
};

static void erase(struct eraser *eraser, size_t at, size_t bytes)
{
    const size_t limit = at < eraser->directory ? eraser->directory : eraser->tiff->size;
    const size_t room =
        at >= limit || (at < eraser->end && at >= eraser->directory) || at < 8 ? 0 : limit - at;
    const size_t most = room < eraser->budget ? room : eraser->budget;
    const size_t n = bytes < most ? bytes : most;

    if (n > 0) {
        memset(eraser->tiff->data + at, 0, n);
        eraser->budget -= n;
    }
}

static void erase_all(struct eraser *eraser, const struct rf_tiff_entry *places,
                      const struct rf_tiff_entry *sizes)
{
    const uint32_t count = places->count < sizes->count ? places->count : sizes->count;

    for (uint32_t i = 0; i < count && eraser->budget > 0; i++) {
        erase(eraser, rf_tiff_integer(eraser->tiff, places, i),
              rf_tiff_integer(eraser->tiff, sizes, i));
    }
}

static void erase_thumbnail(struct eraser *eraser, size_t thumbnail)
{
    struct rf_tiff_entry jpeg = {0}, jpeg_bytes = {0}, strips = {0}, strip_bytes = {0}, entry;
    const int count = rf_tiff_count(eraser->tiff, thumbnail);

    for (int i = 0; i < count; i++) {
        if (!rf_tiff_entry(eraser->tiff, thumbnail, i, &entry))
            continue;
        if (entry.tag == TAG_THUMBNAIL)
            jpeg = entry;
        else if (entry.tag == TAG_THUMBNAIL_BYTES)
            jpeg_bytes = entry;
        else if (entry.tag == TAG_STRIPS)
            strips = entry;
        else if (entry.tag == TAG_STRIP_BYTES)
            strip_bytes = entry;
    }
    erase_all(eraser, &jpeg, &jpeg_bytes);
    erase_all(eraser, &strips, &strip_bytes);
    eraser->budget = eraser->tiff->size;
    erase(eraser, thumbnail, count < 0 ? 0 : 2 + (size_t)count * 12 + 4);
}

void rf_tiff_drop_thumbnail(struct rf_tiff *tiff, size_t directory)
{
    const int count = rf_tiff_count(tiff, directory);
    const size_t link = directory + 2 + (size_t)count * 12; /* The link follows the entries. */

    if (count == (int)rf_tiff_get16(tiff, directory) && tiff->size - link >= 4) {
        struct eraser eraser = {tiff, directory, link + 4, tiff->size};
        const size_t thumbnail = rf_tiff_get32(tiff, link);

        memset(tiff->data + link, 0, 4);
        if (thumbnail > 0)
            erase_thumbnail(&eraser, thumbnail);
    }
}
