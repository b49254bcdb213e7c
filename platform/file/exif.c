/* exif.c: the EXIF block of a photo is read and corrected. It is a TIFF structure of one main
 * directory and one for the camera's settings. Only these two are ever followed, so that no chain
 * of offsets, circular or not, can be long. */
#include "exif.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exif_subject.h"
#include "reason.h"

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
    TAG_WIDTH = 0xa002,
    TAG_HEIGHT = 0xa003,
    TAG_CUSTOM_RENDERED = 0xa401,
    TAG_FOCAL_LENGTH_35MM = 0xa405,
    TAG_LENS_MODEL = 0xa434,
    TAG_APPLE_ACCELERATION = 8, /* in Apple's maker note */
    TAG_APPLE_HDR_HEADROOM = 0x21,
    TAG_APPLE_HDR_GAIN = 0x30,
};
enum { APPLE_PORTRAIT_HDR = 7, APPLE_PORTRAIT = 8 }; /* values of TAG_CUSTOM_RENDERED */

static double get_rational(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry)
{
    uint32_t below;

    if (entry->type != RF_TIFF_RATIONAL)
        return 0.0;
    below = rf_tiff_get32(tiff, entry->value + 4);
    return below ? rf_tiff_get32(tiff, entry->value) / (double)below : 0.0;
}

/* 0 is not known, and the greatest numerator infinity. */
static double get_distance(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry)
{
    const bool infinite =
        entry->type == RF_TIFF_RATIONAL && rf_tiff_get32(tiff, entry->value) == UINT32_MAX;

    return infinite ? INFINITY : get_rational(tiff, entry);
}

static bool get_signed_rational(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry,
                                double *value)
{
    int32_t above, below;

    if (entry->type != RF_TIFF_SIGNED_RATIONAL)
        return false;
    above = (int32_t)rf_tiff_get32(tiff, entry->value);
    below = (int32_t)rf_tiff_get32(tiff, entry->value + 4);
    *value = below ? above / (double)below : 0;
    return below != 0;
}

static void get_text(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry, char *text,
                     size_t size)
{
    size_t n = 0;

    if (entry->type != RF_TIFF_ASCII)
        return;
    for (; n < entry->count && n + 1 < size && tiff->data[entry->value + n]; n++)
        text[n] = (char)tiff->data[entry->value + n];
    while (n > 0 && text[n - 1] == ' ')
        n--;
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

/* How the phone was held, by gravity in units of g: -1 along the second axis when upright, which
 * is orientation 6 of the camera on its back. */
static int find_held(const struct rf_tiff *note, const struct rf_tiff_entry *entry)
{
    double axis[2];

    for (size_t i = 0; i < 2; i++) {
        struct rf_tiff_entry one = *entry;

        one.value += 8 * i;
        if (entry->count != 3 || !get_signed_rational(note, &one, &axis[i]))
            return 0;
    }
    return fabs(axis[1]) <= fabs(axis[0]) ? 0 : axis[1] < 0 ? 6 : 8;
}

/* The note of an iPhone: 14 bytes, and a directory whose offsets count from the note's first. */
static void read_maker_note(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry,
                            struct rf_exif *exif)
{
    const struct rf_tiff note = {tiff->data + entry->value, entry->count, true};
    bool has_headroom = false, has_gain = false;
    double headroom = 0, gain = 0;
    int count;

    if (entry->count < 14 || memcmp(note.data, "Apple iOS\0\0\1MM", 14) != 0)
        return;
    count = rf_tiff_count(&note, 14);
    for (int i = 0; i < count; i++) {
        struct rf_tiff_entry own;

        if (!rf_tiff_entry(&note, 14, i, &own))
            continue;
        if (own.tag == TAG_APPLE_ACCELERATION)
            exif->subject.held = find_held(&note, &own);
        else if (own.tag == TAG_APPLE_HDR_HEADROOM)
            has_headroom = get_signed_rational(&note, &own, &headroom);
        else if (own.tag == TAG_APPLE_HDR_GAIN)
            has_gain = get_signed_rational(&note, &own, &gain);
    }
    if (has_headroom && has_gain)
        exif->apple_headroom = apple_headroom(headroom, gain);
}

static void read_settings(struct rf_tiff *tiff, size_t directory, struct rf_exif *exif)
{
    const int count = rf_tiff_count(tiff, directory);
    struct rf_tiff_entry width = {0}, height = {0}, area = {0}, entry;
    char lens[64] = "";
    uint32_t custom = 0;

    for (int i = 0; i < count; i++) {
        if (!rf_tiff_entry(tiff, directory, i, &entry))
            continue;
        if (entry.tag == TAG_F_NUMBER)
            exif->f_number = get_rational(tiff, &entry);
        else if (entry.tag == TAG_FOCAL_LENGTH)
            exif->focal_length_mm = get_rational(tiff, &entry);
        else if (entry.tag == TAG_FOCAL_LENGTH_35MM)
            exif->focal_length_35mm = rf_tiff_integer(tiff, &entry, 0);
        else if (entry.tag == TAG_CUSTOM_RENDERED)
            custom = rf_tiff_integer(tiff, &entry, 0);
        else if (entry.tag == TAG_SUBJECT_DISTANCE)
            exif->subject_distance = get_distance(tiff, &entry);
        else if (entry.tag == TAG_MAKER_NOTE && entry.type == RF_TIFF_UNDEFINED)
            read_maker_note(tiff, &entry, exif);
        else if (entry.tag == TAG_WIDTH && entry.type <= RF_TIFF_RATIONAL)
            width = entry;
        else if (entry.tag == TAG_HEIGHT && entry.type <= RF_TIFF_RATIONAL)
            height = entry;
        else if (entry.tag == TAG_LENS_MODEL)
            get_text(tiff, &entry, lens, sizeof lens);
        else if (entry.tag == RF_EXIF_SUBJECT_AREA)
            area = entry;
    }
    exif->is_portrait = strncmp(exif->camera, "Apple", 5) == 0 &&
                        (custom == APPLE_PORTRAIT || custom == APPLE_PORTRAIT_HDR);
    if (strstr(lens, "front")) /* A front camera may mirror its photos. */
        exif->subject.held = 0;
    rf_subject_read(tiff, &area, &width, &height, &exif->subject);
    if (exif->orientation >= 5 && width.count == 1 && height.count == 1) {
        /* Exchange the tags, not the values: types may differ. Their order, which TIFF
         * wants ascending, is put right by exchanging the rest of the entries too. */
        uint8_t rest[10];
        memcpy(rest, tiff->data + width.place + 2, 10);
        memcpy(tiff->data + width.place + 2, tiff->data + height.place + 2, 10);
        memcpy(tiff->data + height.place + 2, rest, 10);
    }
    if (exif->orientation != 1)
        rf_subject_turn(tiff, directory, &exif->subject);
}

bool rf_exif_parse(uint8_t *data, size_t size, struct rf_exif *exif)
{
    struct rf_tiff tiff = {data, size, false};
    char make[48] = "", model[64] = "";
    size_t directory, settings = 0;
    struct rf_tiff_entry entry;
    int count;

    memset(exif, 0, sizeof *exif);
    exif->orientation = 1;
    exif->subject.x = exif->subject.y = -1.0;
    if (size < 8 || (memcmp(data, "MM\0*", 4) != 0 && memcmp(data, "II*\0", 4) != 0))
        return false;
    tiff.big_endian = data[0] == 'M';
    directory = rf_tiff_get32(&tiff, 4);
    count = rf_tiff_count(&tiff, directory);
    if (count < 0)
        return false;
    for (int i = 0; i < count; i++) {
        if (!rf_tiff_entry(&tiff, directory, i, &entry))
            continue;
        if (entry.tag == TAG_MAKE) {
            get_text(&tiff, &entry, make, sizeof make);
        } else if (entry.tag == TAG_MODEL) {
            get_text(&tiff, &entry, model, sizeof model);
        } else if (entry.tag == TAG_ORIENTATION && entry.type == RF_TIFF_SHORT) {
            const uint32_t value = rf_tiff_get16(&tiff, entry.value);
            exif->orientation = value >= 1 && value <= 8 ? (int)value : 1;
            rf_tiff_put16(&tiff, entry.value, 1);
        } else if (entry.tag == TAG_SETTINGS) {
            settings = rf_tiff_integer(&tiff, &entry, 0);
        }
    }
    join_camera(exif, make, model);
    exif->subject.orientation = exif->orientation;
    if (settings != 0)
        read_settings(&tiff, settings, exif);
    rf_tiff_drop_thumbnail(&tiff, directory);
    return true;
}

/* Set a side of the picture; returns whether it was that long before. */
static bool set_side(struct rf_tiff *tiff, const struct rf_tiff_entry *entry, uint32_t side)
{
    const bool same = entry->count == 1 && rf_tiff_integer(tiff, entry, 0) == side;

    rf_tiff_set_integer(tiff, entry, side);
    return same;
}

/* The subject's place is in pixels of a picture of the old size, of which this may be any part. */
void rf_exif_set_size(uint8_t *data, size_t size, uint32_t width, uint32_t height)
{
    struct rf_tiff tiff = {data, size, size > 0 && data[0] == 'M'};
    size_t directories[2] = {0, 0};
    struct rf_tiff_entry entry;

    if (size < 8)
        return;
    directories[0] = rf_tiff_get32(&tiff, 4);
    for (int d = 0; d < 2; d++) {
        const int count = directories[d] > 0 ? rf_tiff_count(&tiff, directories[d]) : 0;
        bool same_width = false, same_height = false;

        for (int i = 0; i < count; i++) {
            if (!rf_tiff_entry(&tiff, directories[d], i, &entry))
                continue;
            if (entry.tag == TAG_SETTINGS && d == 0)
                directories[1] = rf_tiff_integer(&tiff, &entry, 0);
            else if (entry.tag == (d == 0 ? TAG_MAIN_WIDTH : TAG_WIDTH))
                same_width = set_side(&tiff, &entry, width);
            else if (entry.tag == (d == 0 ? TAG_MAIN_HEIGHT : TAG_HEIGHT))
                same_height = set_side(&tiff, &entry, height);
        }
        if (d == 1 && count > 0 && !(same_width && same_height)) {
            rf_tiff_drop(&tiff, directories[1], RF_EXIF_SUBJECT_AREA);
            rf_tiff_drop(&tiff, directories[1], RF_EXIF_SUBJECT_LOCATION);
        }
    }
}

int rf_exif_take(struct rf_read *read, struct rf_bytes tiff, bool orient)
{
    struct refocus_photo_info *const info = read->info;
    struct rf_exif exif;

    if (tiff.size == 0 || read->exif.data)
        return REFOCUS_OK;
    read->exif.data = malloc(tiff.size);
    if (!read->exif.data)
        return rf_fail_memory(read->reason);
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
    read->subject = exif.subject;
    if (exif.is_portrait)
        rf_note(info, "EXIF: a portrait, blurred by the phone: further blur adds to that");
    memcpy(info->camera, exif.camera, sizeof info->camera);
    read->apple_headroom = exif.apple_headroom;
    if (orient)
        read->orientation = exif.orientation;
    return REFOCUS_OK;
}
