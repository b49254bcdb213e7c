/* exif.c: the EXIF block of a photo is read and corrected. It is a TIFF structure of one main
 * directory and one for the camera's settings. Only these two are ever followed, so that no chain
 * of offsets, circular or not, can be long. */
#include "exif.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"

struct tiff {
    uint8_t *data;
    size_t size;
    bool big_endian;
};

struct entry {
    size_t place; /* offset of the 12 bytes of the entry */
    uint32_t tag, type, count;
    size_t value; /* offset of the value */
};

enum {
    TAG_MAIN_WIDTH = 0x0100,
    TAG_MAIN_HEIGHT = 0x0101,
    TAG_MAKE = 0x010f,
    TAG_MODEL = 0x0110,
    TAG_ORIENTATION = 0x0112,
    TAG_SETTINGS = 0x8769,
    TAG_F_NUMBER = 0x829d,
    TAG_FOCAL_LENGTH = 0x920a,
    TAG_SUBJECT_DISTANCE = 0x9206,
    TAG_MAKER_NOTE = 0x927c,
    TAG_SUBJECT_AREA = 0x9214,
    TAG_WIDTH = 0xa002,
    TAG_HEIGHT = 0xa003,
    TAG_CUSTOM_RENDERED = 0xa401,
    TAG_FOCAL_LENGTH_35MM = 0xa405,
    TAG_APPLE_HDR_HEADROOM = 0x21, /* in Apple's maker note */
    TAG_APPLE_HDR_GAIN = 0x30,
};
enum { APPLE_PORTRAIT_HDR = 7, APPLE_PORTRAIT = 8 }; /* values of TAG_CUSTOM_RENDERED */
enum {
    TYPE_ASCII = 2,
    TYPE_SHORT = 3,
    TYPE_LONG = 4,
    TYPE_RATIONAL = 5,
    TYPE_UNDEFINED = 7,
    TYPE_SIGNED_RATIONAL = 10
};

static uint32_t get16(const struct tiff *tiff, size_t at)
{
    const uint8_t *const b = tiff->data + at;

    return tiff->big_endian ? (uint32_t)(b[0] << 8 | b[1]) : (uint32_t)(b[1] << 8 | b[0]);
}

static uint32_t get32(const struct tiff *tiff, size_t at)
{
    const uint32_t first = get16(tiff, at), second = get16(tiff, at + 2);

    return tiff->big_endian ? first << 16 | second : second << 16 | first;
}

static void put16(struct tiff *tiff, size_t at, uint32_t value)
{
    tiff->data[at] = (uint8_t)(tiff->big_endian ? value >> 8 : value);
    tiff->data[at + 1] = (uint8_t)(tiff->big_endian ? value : value >> 8);
}

/* Entries that a directory really has room for; -1 when not even their number fits. */
static int count_entries(const struct tiff *tiff, size_t directory)
{
    size_t room;

    if (directory > tiff->size || tiff->size - directory < 2) {
        return -1;
    }
    room = (tiff->size - directory - 2) / 12;
    return get16(tiff, directory) <= room ? (int)get16(tiff, directory) : (int)room;
}

/* False for an entry whose value lies outside the block or is of no type used here. */
static bool get_entry(const struct tiff *tiff, size_t directory, int index, struct entry *entry)
{
    static const uint8_t type_bytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8};
    uint64_t bytes;

    entry->place = directory + 2 + (size_t)index * 12;
    entry->tag = get16(tiff, entry->place);
    entry->type = get16(tiff, entry->place + 2);
    entry->count = get32(tiff, entry->place + 4);
    if (entry->type == 0 || entry->type > TYPE_SIGNED_RATIONAL || entry->count == 0) {
        return false;
    }
    bytes = (uint64_t)entry->count * type_bytes[entry->type];
    entry->value = bytes <= 4 ? entry->place + 8 : get32(tiff, entry->place + 8);
    return entry->value <= tiff->size && bytes <= tiff->size - entry->value;
}

static uint32_t get_integer(const struct tiff *tiff, const struct entry *entry)
{
    return entry->type == TYPE_SHORT  ? get16(tiff, entry->value)
           : entry->type == TYPE_LONG ? get32(tiff, entry->value)
                                      : 0;
}

static double get_rational(const struct tiff *tiff, const struct entry *entry)
{
    uint32_t below;

    if (entry->type != TYPE_RATIONAL) {
        return 0.0;
    }
    below = get32(tiff, entry->value + 4);
    return below ? get32(tiff, entry->value) / (double)below : 0.0;
}

/* 0 is not known, and the greatest numerator infinity. */
static double get_distance(const struct tiff *tiff, const struct entry *entry)
{
    const bool infinite = entry->type == TYPE_RATIONAL && get32(tiff, entry->value) == UINT32_MAX;

    return infinite ? INFINITY : get_rational(tiff, entry);
}

static bool get_signed_rational(const struct tiff *tiff, const struct entry *entry, double *value)
{
    int32_t above, below;

    if (entry->type != TYPE_SIGNED_RATIONAL) {
        return false;
    }
    above = (int32_t)get32(tiff, entry->value);
    below = (int32_t)get32(tiff, entry->value + 4);
    *value = below ? above / (double)below : 0;
    return below != 0;
}

static void get_text(const struct tiff *tiff, const struct entry *entry, char *text, size_t size)
{
    size_t n = 0;

    if (entry->type != TYPE_ASCII) {
        return;
    }
    for (; n < entry->count && n + 1 < size && tiff->data[entry->value + n]; n++) {
        text[n] = (char)tiff->data[entry->value + n];
    }
    while (n > 0 && text[n - 1] == ' ') {
        n--;
    }
    text[n] = '\0';
    rf_clean_text(text);
}

/* Most models repeat the make: "Canon" and "Canon EOS R5". */
static void join_camera(struct rf_exif *exif, const char *make, const char *model)
{
    if (make[0] == '\0' || strncmp(model, make, strlen(make)) == 0) {
        snprintf(exif->camera, sizeof exif->camera, "%s", model);
    } else {
        snprintf(exif->camera, sizeof exif->camera, "%s%s%.*s", make, model[0] ? " " : "",
                 (int)(sizeof exif->camera - 2 - strlen(make)), model);
    }
}

/* Apple, "Applying Apple HDR effect to your photos". */
static double apple_headroom(double headroom, double gain)
{
    const double stops = headroom < 1 ? (gain <= 0.01 ? -20 * gain + 1.8 : -0.101 * gain + 1.601)
                                      : (gain <= 0.01 ? -70 * gain + 3 : -0.303 * gain + 2.303);

    return exp2(stops < 0 ? 0 : stops > 16 ? 16 : stops);
}

/* The note of an iPhone: 14 bytes, and a directory whose offsets count from the note's first. */
static void read_maker_note(const struct tiff *tiff, const struct entry *entry,
                            struct rf_exif *exif)
{
    const struct tiff note = {tiff->data + entry->value, entry->count, true};
    bool has_headroom = false, has_gain = false;
    double headroom = 0, gain = 0;
    int count;

    if (entry->count < 14 || memcmp(note.data, "Apple iOS\0\0\1MM", 14) != 0) {
        return;
    }
    count = count_entries(&note, 14);
    for (int i = 0; i < count; i++) {
        struct entry own;

        if (!get_entry(&note, 14, i, &own)) {
            continue;
        }
        if (own.tag == TAG_APPLE_HDR_HEADROOM) {
            has_headroom = get_signed_rational(&note, &own, &headroom);
        } else if (own.tag == TAG_APPLE_HDR_GAIN) {
            has_gain = get_signed_rational(&note, &own, &gain);
        }
    }
    if (has_headroom && has_gain) {
        exif->apple_headroom = apple_headroom(headroom, gain);
    }
}

/* Two to four numbers, of which the first two are the middle of the subject in pixels. */
static void find_subject(const struct tiff *tiff, const struct entry *area,
                         const struct entry *width, const struct entry *height,
                         struct rf_exif *exif)
{
    const bool known = area->type == TYPE_SHORT && area->count >= 2 && area->count <= 4 &&
                       width->count == 1 && height->count == 1;
    const uint32_t x = known ? get16(tiff, area->value) : 0;
    const uint32_t y = known ? get16(tiff, area->value + 2) : 0;

    if (known && x < get_integer(tiff, width) && y < get_integer(tiff, height)) {
        exif->subject_x = (x + 0.5) / get_integer(tiff, width);
        exif->subject_y = (y + 0.5) / get_integer(tiff, height);
    }
}

static void read_settings(struct tiff *tiff, size_t directory, struct rf_exif *exif)
{
    const int count = count_entries(tiff, directory);
    struct entry width = {0}, height = {0}, area = {0}, entry;
    uint32_t custom = 0;

    for (int i = 0; i < count; i++) {
        if (!get_entry(tiff, directory, i, &entry)) {
            continue;
        }
        if (entry.tag == TAG_F_NUMBER) {
            exif->f_number = get_rational(tiff, &entry);
        } else if (entry.tag == TAG_FOCAL_LENGTH) {
            exif->focal_length_mm = get_rational(tiff, &entry);
        } else if (entry.tag == TAG_FOCAL_LENGTH_35MM) {
            exif->focal_length_35mm = get_integer(tiff, &entry);
        } else if (entry.tag == TAG_CUSTOM_RENDERED) {
            custom = get_integer(tiff, &entry);
        } else if (entry.tag == TAG_SUBJECT_DISTANCE) {
            exif->subject_distance = get_distance(tiff, &entry);
        } else if (entry.tag == TAG_MAKER_NOTE && entry.type == TYPE_UNDEFINED) {
            read_maker_note(tiff, &entry, exif);
        } else if (entry.tag == TAG_WIDTH && entry.type <= TYPE_RATIONAL) {
            width = entry;
        } else if (entry.tag == TAG_HEIGHT && entry.type <= TYPE_RATIONAL) {
            height = entry;
        } else if (entry.tag == TAG_SUBJECT_AREA) {
            area = entry;
        }
    }
    exif->is_portrait = strncmp(exif->camera, "Apple", 5) == 0 &&
                        (custom == APPLE_PORTRAIT || custom == APPLE_PORTRAIT_HDR);
    find_subject(tiff, &area, &width, &height, exif);
    if (exif->orientation >= 5 && width.count == 1 && height.count == 1) {
        /* Exchange the tags, not the values: types may differ. Their order, which TIFF
         * wants ascending, is put right by exchanging the rest of the entries too. */
        uint8_t rest[10];
        memcpy(rest, tiff->data + width.place + 2, 10);
        memcpy(tiff->data + width.place + 2, tiff->data + height.place + 2, 10);
        memcpy(tiff->data + height.place + 2, rest, 10);
    }
}

bool rf_exif_parse(uint8_t *data, size_t size, struct rf_exif *exif)
{
    struct tiff tiff = {data, size, false};
    char make[48] = "", model[64] = "";
    size_t directory, settings = 0, next;
    struct entry entry;
    int count;

    memset(exif, 0, sizeof *exif);
    exif->orientation = 1;
    exif->subject_x = exif->subject_y = -1.0;
    if (size < 8 || (memcmp(data, "MM\0*", 4) != 0 && memcmp(data, "II*\0", 4) != 0)) {
        return false;
    }
    tiff.big_endian = data[0] == 'M';
    directory = get32(&tiff, 4);
    count = count_entries(&tiff, directory);
    if (count < 0) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        if (!get_entry(&tiff, directory, i, &entry)) {
            continue;
        }
        if (entry.tag == TAG_MAKE) {
            get_text(&tiff, &entry, make, sizeof make);
        } else if (entry.tag == TAG_MODEL) {
            get_text(&tiff, &entry, model, sizeof model);
        } else if (entry.tag == TAG_ORIENTATION && entry.type == TYPE_SHORT) {
            const uint32_t value = get16(&tiff, entry.value);
            exif->orientation = value >= 1 && value <= 8 ? (int)value : 1;
            put16(&tiff, entry.value, 1);
        } else if (entry.tag == TAG_SETTINGS) {
            settings = get_integer(&tiff, &entry);
        }
    }
    join_camera(exif, make, model);
    if (settings != 0) {
        read_settings(&tiff, settings, exif);
    }
    /* The link to the thumbnail's directory follows the entries. */
    next = directory + 2 + (size_t)count * 12;
    if (count == (int)get16(&tiff, directory) && size - next >= 4) {
        memset(data + next, 0, 4);
    }
    return true;
}

static void set_integer(struct tiff *tiff, const struct entry *entry, uint32_t value)
{
    if (entry->count == 1 && entry->type == TYPE_LONG) {
        put16(tiff, entry->value, tiff->big_endian ? value >> 16 : value & 0xffff);
        put16(tiff, entry->value + 2, tiff->big_endian ? value & 0xffff : value >> 16);
    } else if (entry->count == 1 && entry->type == TYPE_SHORT && value <= UINT16_MAX) {
        put16(tiff, entry->value, value);
    }
}

void rf_exif_set_size(uint8_t *data, size_t size, uint32_t width, uint32_t height)
{
    struct tiff tiff = {data, size, size > 0 && data[0] == 'M'};
    size_t directories[2] = {0, 0};
    struct entry entry;

    if (size < 8) {
        return;
    }
    directories[0] = get32(&tiff, 4);
    for (int d = 0; d < 2; d++) {
        const int count = directories[d] > 0 ? count_entries(&tiff, directories[d]) : 0;

        for (int i = 0; i < count; i++) {
            if (!get_entry(&tiff, directories[d], i, &entry)) {
                continue;
            }
            if (entry.tag == TAG_SETTINGS && d == 0) {
                directories[1] = get_integer(&tiff, &entry);
            } else if (entry.tag == (d == 0 ? TAG_MAIN_WIDTH : TAG_WIDTH)) {
                set_integer(&tiff, &entry, width);
            } else if (entry.tag == (d == 0 ? TAG_MAIN_HEIGHT : TAG_HEIGHT)) {
                set_integer(&tiff, &entry, height);
            }
        }
    }
}

int rf_exif_take(struct rf_read *read, struct rf_bytes tiff, bool orient)
{
    struct refocus_photo_info *const info = read->info;
    struct rf_exif exif;

    if (tiff.size == 0 || read->exif.data) {
        return REFOCUS_OK;
    }
    read->exif.data = malloc(tiff.size);
    if (!read->exif.data) {
        return rf_fail_memory(read->reason);
    }
    memcpy(read->exif.data, tiff.data, tiff.size);
    read->exif.size = tiff.size;
    if (!rf_exif_parse(read->exif.data, read->exif.size, &exif)) {
        rf_note(info, "EXIF: damaged, passed over");
        free(read->exif.data);
        read->exif.data = NULL;
        read->exif.size = 0;
        return REFOCUS_OK;
    }
    info->focal_length_mm = exif.focal_length_mm;
    info->focal_length_35mm = exif.focal_length_35mm;
    info->f_number = exif.f_number;
    info->subject_distance = exif.subject_distance;
    if (exif.subject_x >= 0.0) {
        info->focus_x = exif.subject_x;
        info->focus_y = exif.subject_y;
        rf_note(info, "EXIF: the middle of the subject area, taken for the focus point");
    }
    if (exif.is_portrait) {
        rf_note(info, "EXIF: a portrait, blurred by the phone: further blur adds to that");
    }
    memcpy(info->camera, exif.camera, sizeof info->camera);
    read->apple_headroom = exif.apple_headroom;
    if (orient) {
        read->orientation = exif.orientation;
    }
    return REFOCUS_OK;
}
