/* heif_tone_map.c: the gain map that a HEIF container holds for its main picture is found.
 *
 * A derived item of type "tmap" is the brighter rendition of a picture, made of it and of a gain
 * map, a hidden item. Its data are the version of its form, 0, and what ISO 21496-1 says of the
 * map. libheif 1.15 passes over such items and gives hidden ones to nobody, so a copy of the file
 * is made in which the map is the main picture.
 *
 *     pitm 33   iinf { 33 grid, 37 grid hidden, 38 tmap }   iref { dimg: 38 -> 33, 37 }
 *     pitm 37   iinf { 33 grid, 37 grid,        38 tmap }
 *
 * ISO/IEC 23008-12:2022/Amd 1, 6.6.2.4; ISO/IEC 14496-12, 8.11.
 */
#include "heif_tone_map.h"

#include <stdlib.h>
#include <string.h>

#include <refocus/refocus.h>

#include "heif_boxes.h"

/* Fields that are taken off the front, one by one. */
struct fields {
    struct rf_bytes left;
    bool short_of; /* bytes were missing */
};

static uint64_t take(struct fields *fields, size_t size)
{
    uint64_t value;

    if (size > 8 || fields->left.size < size) {
        fields->short_of = true;
        fields->left.size = 0;
        return 0;
    }
    value = size > 4 ? rf_big_endian(fields->left.data, size - 4) : 0;
    value = value << 32 |
            rf_big_endian(fields->left.data + (size > 4 ? size - 4 : 0), size > 4 ? 4 : size);
    rf_heif_skip(&fields->left, size);
    return value;
}

/* Version and flags of a full box. */
static uint32_t take_version(struct fields *fields)
{
    return (uint32_t)take(fields, 4) >> 24;
}

/* An item, as the container describes it. */
struct item {
    uint32_t number;
    char type[5];
    const uint8_t *flags; /* in the file; bit 0: the item is hidden */
};

/* Take the next item off the boxes behind the count of `iinf`. */
static bool next_item(struct rf_bytes *rest, struct item *item)
{
    struct rf_heif_box box;

    while (rf_heif_next(rest, &box)) {
        struct fields fields = {box.content, false};
        const uint32_t version = take_version(&fields);

        if (strcmp(box.type, "infe") == 0 && version >= 2) {
            item->number = (uint32_t)take(&fields, version == 2 ? 2 : 4);
            take(&fields, 2); /* protection */
            if (!fields.short_of && fields.left.size >= 4) {
                item->flags = box.content.data + 3;
                memcpy(item->type, fields.left.data, 4);
                item->type[4] = '\0';
                return true;
            }
        }
    }
    return false;
}

/* The first item of a type or, where `type` is NULL, the one of a number. */
static bool find_item(struct rf_bytes meta, const char *type, uint32_t number, struct item *item)
{
    struct fields iinf = {{NULL, 0}, false};

    if (!rf_heif_find(meta, "iinf", &iinf.left))
        return false;
    take(&iinf, take_version(&iinf) == 0 ? 2 : 4); /* the count is passed over: the boxes tell */
    while (next_item(&iinf.left, item))
        if (type ? strcmp(item->type, type) == 0 : item->number == number)
            return true;
    return false;
}

/* The items that one is derived from; false unless there are two. */
static bool find_sources(struct rf_bytes meta, uint32_t number, uint32_t source[2])
{
    struct fields iref = {{NULL, 0}, false};
    struct rf_heif_box box;
    size_t bytes;

    if (!rf_heif_find(meta, "iref", &iref.left))
        return false;
    bytes = take_version(&iref) == 0 ? 2 : 4;
    while (rf_heif_next(&iref.left, &box)) {
        struct fields fields = {box.content, false};

        if (strcmp(box.type, "dimg") == 0 && take(&fields, bytes) == number) {
            const bool two = take(&fields, 2) == 2;

            source[0] = (uint32_t)take(&fields, bytes);
            source[1] = (uint32_t)take(&fields, bytes);
            return two && !fields.short_of;
        }
    }
    return false;
}

/* Sizes of the fields in `iloc`. */
struct location_sizes {
    size_t number, method, base, index, offset, length;
};

/* Where an item's data lie, in one piece. method 0: counted from the file's begin, 1: in `idat`. */
struct location {
    uint64_t method, offset, length;
};

static bool take_location(struct fields *fields, const struct location_sizes *sizes,
                          uint32_t wanted, struct location *location)
{
    const uint64_t number = take(fields, sizes->number);
    uint64_t pieces;

    location->method = take(fields, sizes->method) & 15;
    take(fields, 2); /* reference to another file */
    location->offset = take(fields, sizes->base);
    pieces = take(fields, 2);
    if (number != wanted) {
        /* 65,535 pieces of 24 bytes at most. */
        const size_t skipped = (size_t)pieces * (sizes->index + sizes->offset + sizes->length);

        fields->short_of |= skipped > fields->left.size;
        rf_heif_skip(&fields->left, fields->short_of ? fields->left.size : skipped);
        return false;
    }
    take(fields, sizes->index);
    location->offset += take(fields, sizes->offset);
    location->length = take(fields, sizes->length);
    fields->short_of |= pieces != 1;
    return !fields->short_of;
}

static bool find_location(struct rf_bytes meta, uint32_t wanted, struct location *location)
{
    struct fields iloc = {{NULL, 0}, false};
    struct location_sizes sizes;
    uint32_t version, packed;

    if (!rf_heif_find(meta, "iloc", &iloc.left))
        return false;
    version = take_version(&iloc);
    packed = (uint32_t)take(&iloc, 2);
    sizes = (struct location_sizes){.number = version < 2 ? 2 : 4,
                                    .method = version == 0 ? 0 : 2,
                                    .base = packed >> 4 & 15,
                                    .index = version == 0 ? 0 : packed & 15,
                                    .offset = packed >> 12,
                                    .length = packed >> 8 & 15};
    for (uint64_t left = take(&iloc, sizes.number); left > 0 && !iloc.short_of; left--)
        if (take_location(&iloc, &sizes, wanted, location))
            return true;
    return false;
}

static bool find_data(struct rf_bytes file, struct rf_bytes meta, uint32_t number,
                      struct rf_bytes *data)
{
    struct location at;

    *data = file;
    if (!find_location(meta, number, &at) || at.method > 1 ||
        (at.method == 1 && !rf_heif_find(meta, "idat", data)) || at.offset > data->size ||
        at.length > data->size - at.offset)
        return false;
    data->data += at.offset;
    data->size = (size_t)at.length;
    return true;
}

bool rf_heif_find_tone_map(struct rf_bytes file, struct rf_heif_tone_map *map)
{
    struct rf_bytes meta, primary;
    struct item item;
    uint32_t source[2];

    if (!rf_heif_meta(file, &meta) || !rf_heif_primary(meta, &primary) ||
        !find_item(meta, "tmap", 0, &item) || !find_sources(meta, item.number, source) ||
        source[0] != rf_big_endian(primary.data, primary.size) || source[1] == source[0])
        return false;
    map->item = source[1];
    return find_data(file, meta, item.number, &map->metadata);
}

int rf_heif_with_main_picture(struct rf_bytes file, uint32_t item, uint8_t **changed)
{
    struct rf_bytes meta, primary;
    struct item found;

    *changed = NULL;
    if (!rf_heif_meta(file, &meta) || !rf_heif_primary(meta, &primary) ||
        !find_item(meta, NULL, item, &found) || (primary.size == 2 && item > UINT16_MAX))
        return REFOCUS_ERR_FORMAT;
    *changed = malloc(file.size);
    if (!*changed)
        return REFOCUS_ERR_MEMORY;
    memcpy(*changed, file.data, file.size);
    (*changed)[found.flags - file.data] &= 0xfe;
    for (size_t i = 0; i < primary.size; i++) {
        (*changed)[primary.data - file.data + (ptrdiff_t)i] =
            (uint8_t)(item >> 8 * (primary.size - 1 - i));
    }
    return REFOCUS_OK;
}
