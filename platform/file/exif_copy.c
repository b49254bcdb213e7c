/* exif_copy.c: directories of a TIFF are copied with their values, and offsets made true. Two
 * levels are followed and no more. */
#include "exif_copy.h"

#include <string.h>

enum {
    TAG_SETTINGS = 0x8769,
    TAG_PLACE = 0x8825,
    TAG_MAKER_NOTE = 0x927c,
    TAG_INTEROPERABILITY = 0xa005,
    MOST_VALUE = 16384
};

struct copy {
    struct rf_bytes from;
    bool high_first;
    uint8_t *to;
    size_t size;   /* bytes in `to` */
    uint32_t base; /* where they begin in their file */
};

struct entry {
    uint32_t tag, value, bytes;
    size_t at;
};

static uint32_t number(const struct copy *copy, const uint8_t *from, size_t size)
{
    return copy->high_first ? rf_big_endian(from, size) : rf_little_endian(from, size);
}

static void put(const struct copy *copy, uint8_t *to, int size, uint32_t value)
{
    for (int i = 0; i < size; i++)
        to[copy->high_first ? size - 1 - i : i] = (uint8_t)(value >> 8 * i);
}

static bool begin(struct copy *copy)
{
    const struct rf_bytes from = copy->from;

    copy->high_first = from.size > 0 && from.data[0] == 'M';
    return from.size >= 8 &&
           (memcmp(from.data, "MM\0*", 4) == 0 || memcmp(from.data, "II*\0", 4) == 0);
}

/* Entries of the directory at an offset, as far as the file has them. */
static uint32_t entries(const struct copy *copy, uint32_t directory)
{
    uint32_t count;
    size_t room;

    if (directory > copy->from.size || copy->from.size - directory < 2)
        return 0;
    count = number(copy, copy->from.data + directory, 2);
    room = (copy->from.size - directory - 2) / 12;
    return count <= room ? count : (uint32_t)room;
}

/* False for one whose value lies outside or is too large. */
static bool get(const struct copy *copy, uint32_t directory, uint32_t index, struct entry *entry)
{
    static const uint8_t type_bytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
    const uint8_t *from;
    uint32_t type;
    uint64_t bytes;

    entry->at = (size_t)directory + 2 + 12 * (size_t)index;
    from = copy->from.data + entry->at;
    entry->tag = number(copy, from, 2);
    entry->value = number(copy, from + 8, 4);
    type = number(copy, from + 2, 2);
    bytes = type < sizeof type_bytes ? (uint64_t)number(copy, from + 4, 4) * type_bytes[type] : 0;
    entry->bytes = (uint32_t)bytes;
    return bytes > 0 && bytes <= MOST_VALUE &&
           (bytes <= 4 ||
            (entry->value <= copy->from.size && bytes <= copy->from.size - entry->value));
}

static bool is_directory(uint32_t tag)
{
    return tag == TAG_SETTINGS || tag == TAG_PLACE;
}

/* Description, make, model, orientation, resolution, program, date, artist, copyright */
static bool is_kept(uint32_t tag, bool main)
{
    static const uint16_t shared[] = {0x10e, 0x10f, 0x110, 0x112,  0x11a,        0x11b,    0x128,
                                      0x131, 0x132, 0x13b, 0x8298, TAG_SETTINGS, TAG_PLACE};

    if (!main)
        return tag != TAG_MAKER_NOTE && tag != TAG_INTEROPERABILITY;
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++)
        if (tag == shared[i])
            return true;
    return false;
}

/* Append bytes at an even offset. */
static bool append(struct copy *copy, const uint8_t *bytes, size_t size, uint32_t *offset)
{
    const size_t at = copy->size + (copy->size & 1);

    if (size > RF_EXIF_COPY_ROOM || at > RF_EXIF_COPY_ROOM - size)
        return false;
    copy->to[copy->size] = 0;
    if (bytes)
        memcpy(copy->to + at, bytes, size);
    else
        memset(copy->to + at, 0, size);
    copy->size = at + size;
    *offset = (uint32_t)at;
    return true;
}

static bool copy_settings(struct copy *copy, uint32_t directory, uint32_t *offset);

/* An entry at a place in `to`; false: it is left out. */
static bool copy_entry(struct copy *copy, const struct entry *entry, uint8_t *place, bool main)
{
    uint32_t offset;

    memcpy(place, copy->from.data + entry->at, 12);
    if (main && is_directory(entry->tag)) {
        if (entry->bytes != 4 || !copy_settings(copy, entry->value, &offset))
            return false;
        put(copy, place + 2, 2, 4); /* LONG, as EXIF wants it; TIFF has a type of its own, too */
        put(copy, place + 4, 4, 1); /* however four bytes were counted */
        put(copy, place + 8, 4, offset + copy->base);
    } else if (entry->bytes > 4) {
        if (!append(copy, copy->from.data + entry->value, entry->bytes, &offset))
            return false;
        put(copy, place + 8, 4, offset + copy->base);
    }
    return true;
}

static bool copy_directory(struct copy *copy, uint32_t directory, bool main, uint32_t *offset)
{
    const uint32_t count = entries(copy, directory);
    struct entry entry;
    uint32_t most = 0, n = 0;

    for (uint32_t i = 0; i < count; i++)
        most += get(copy, directory, i, &entry) && is_kept(entry.tag, main);
    if (most == 0 || !append(copy, NULL, 2 + 12 * (size_t)most + 4, offset))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (get(copy, directory, i, &entry) && is_kept(entry.tag, main))
            n += copy_entry(copy, &entry, copy->to + *offset + 2 + 12 * (size_t)n, main);
    put(copy, copy->to + *offset, 2, n);
    /* No directory follows; an entry that was left out may have been here. */
    memset(copy->to + *offset + 2 + 12 * (size_t)n, 0, 12 * (size_t)(most - n) + 4);
    return n > 0;
}

static bool copy_settings(struct copy *copy, uint32_t directory, uint32_t *offset)
{
    return copy_directory(copy, directory, false, offset);
}

size_t rf_exif_of_tiff(struct rf_bytes tiff, uint8_t *to)
{
    struct copy copy = {.from = tiff, .to = to, .size = 8};
    uint32_t offset;

    if (!begin(&copy) || !copy_directory(&copy, number(&copy, tiff.data + 4, 4), true, &offset))
        return 0;
    memcpy(to, tiff.data, 4);
    put(&copy, to + 4, 4, offset);
    return copy.size;
}

/* The entry of the main directory with that tag. */
static bool find(struct copy *copy, uint32_t tag, struct entry *entry)
{
    uint32_t directory, count;

    if (!begin(copy))
        return false;
    directory = number(copy, copy->from.data + 4, 4);
    count = entries(copy, directory);
    for (uint32_t i = 0; i < count; i++)
        if (get(copy, directory, i, entry) && entry->tag == tag)
            return true;
    return false;
}

size_t rf_exif_directory(struct rf_bytes exif, uint32_t tag, uint32_t base, uint8_t *to)
{
    struct copy copy = {.from = exif, .to = to, .base = base};
    struct entry entry;
    uint32_t offset;

    return find(&copy, tag, &entry) && entry.bytes == 4 &&
                   copy_settings(&copy, entry.value, &offset)
               ? copy.size
               : 0;
}

bool rf_exif_has_maker_note(struct rf_bytes exif)
{
    struct copy copy = {.from = exif};
    struct entry entry;
    uint32_t directory, count;
    bool found = false;

    if (!find(&copy, TAG_SETTINGS, &entry) || entry.bytes != 4)
        return false;
    directory = entry.value;
    count = entries(&copy, directory);
    for (uint32_t i = 0; i < count; i++) {
        get(&copy, directory, i, &entry); /* a note of any size counts */
        found |= entry.tag == TAG_MAKER_NOTE;
    }
    return found;
}

bool rf_exif_text(struct rf_bytes exif, uint32_t tag, char *to, size_t room)
{
    struct copy copy = {.from = exif};
    struct entry entry;
    size_t size;

    if (!find(&copy, tag, &entry) || number(&copy, exif.data + entry.at + 2, 2) != 2)
        return false;
    size = entry.bytes < room - 1 ? entry.bytes : room - 1;
    memcpy(to, exif.data + (entry.bytes > 4 ? entry.value : entry.at + 8), size);
    to[size] = '\0';
    return true;
}
