/* exif_entries.h: EXIF blocks for tests, put together entry by entry, high bytes first. */
#ifndef RF_TEST_EXIF_ENTRIES_H
#define RF_TEST_EXIF_ENTRIES_H

#include "make.h"

enum {
    ASCII = 2,
    SHORT = 3,
    LONG = 4,
    RATIONAL = 5,
    UNDEFINED = 7,
    SIGNED_RATIONAL = 10,
    MAKE = 0x010f,
    MODEL = 0x0110,
    ORIENTATION = 0x0112,
    SETTINGS = 0x8769,
    F_NUMBER = 0x829d,
    SUBJECT_DISTANCE = 0x9206,
    FOCAL_LENGTH = 0x920a,
    MAKER_NOTE = 0x927c,
    SUBJECT_AREA = 0x9214,
    WIDTH = 0xa002,
    HEIGHT = 0xa003,
    CUSTOM_RENDERED = 0xa401,
    FOCAL_LENGTH_35MM = 0xa405,
    SUBJECT_LOCATION = 0xa214,
    LENS_MODEL = 0xa434,
};

static inline void add(struct bytes *block, uint64_t value, int size)
{
    bytes_number(block, value, size, true);
}

/* A directory behind what is there already. */
static inline void directory(struct bytes *block, int count)
{
    if (!block->data) {
        bytes_add(block, "MM\0*", 4);
        add(block, 8, 4);
    }
    add(block, (uint64_t)count, 2);
}

static inline void entry(struct bytes *block, int tag, int type, uint32_t count, uint32_t value)
{
    add(block, (uint64_t)tag, 2);
    add(block, (uint64_t)type, 2);
    add(block, count, 4);
    add(block, value, 4);
}

/* The value of a SHORT lies in the first two of the four bytes. */
static inline void entry_short(struct bytes *block, int tag, uint32_t value)
{
    entry(block, tag, SHORT, 1, value << 16);
}

/* Main directory of one entry and the camera's settings right behind it. */
static inline struct bytes with_settings(int orientation, int count)
{
    struct bytes block = {NULL, 0};

    directory(&block, 2);
    entry_short(&block, ORIENTATION, (uint32_t)orientation);
    entry(&block, SETTINGS, LONG, 1, 8 + 2 + 2 * 12 + 4);
    add(&block, 0, 4);
    directory(&block, count);
    return block;
}

#endif
