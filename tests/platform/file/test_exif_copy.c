/* test_exif_copy.c: EXIF that is copied from a TIFF, a raw or another block: what is taken, what is
 * left out, and that nothing is read or written beyond its block, wherever offsets point. */
#include "check.h"

#include "../../kernels/guarded.h"
#include "exif_copy.h"

enum { BYTE = 1, ASCII, SHORT, LONG, RATIONAL };
enum {
    COLOURS = 0x106, /* not shared */
    MODEL = 0x110,
    TURN = 0x112,
    ARTIST = 0x13b,
    SETTINGS = 0x8769,
    PLACE = 0x8825,
    F_NUMBER = 0x829d,
    MAKER_NOTE = 0x927c,
    OTHERS = 0xa005
};
/* A block whose directory of `count` entries begins at 8. */
struct block {
    struct bytes bytes;
    bool high_first;
};

static struct block block(bool high_first, int count)
{
    struct block made = {{NULL, 0}, high_first};

    bytes_add(&made.bytes, high_first ? "MM\0*" : "II*\0", 4);
    bytes_number(&made.bytes, 8, 4, high_first);
    bytes_number(&made.bytes, (uint64_t)count, 2, high_first);
    return made;
}

static void entry(struct block *to, uint32_t tag, uint32_t type, uint32_t count, uint32_t value)
{
    bytes_number(&to->bytes, tag, 2, to->high_first);
    bytes_number(&to->bytes, type, 2, to->high_first);
    bytes_number(&to->bytes, count, 4, to->high_first);
    if (type == SHORT && count == 1) {
        bytes_number(&to->bytes, value, 2, to->high_first);
        bytes_number(&to->bytes, 0, 2, to->high_first);
    } else {
        bytes_number(&to->bytes, value, 4, to->high_first);
    }
}

static uint32_t number(const uint8_t *from, int size, bool high_first)
{
    uint32_t value = 0;

    for (int i = 0; i < size; i++)
        value = value << 8 | from[high_first ? i : size - 1 - i];
    return value;
}

static uint8_t copied[RF_EXIF_COPY_ROOM + 1];
static bool had_note; /* in what was copied last */

/* The copy, read at the end of a page. */
static size_t copy(const struct block *from)
{
    struct guarded guarded;
    uint8_t *place;
    size_t size;

    assert_true(guarded_create(&guarded, from->bytes.size));
    place = guarded_place(&guarded, from->bytes.size, 1, AT_END, 0);
    memcpy(place, from->bytes.data, from->bytes.size);
    copied[RF_EXIF_COPY_ROOM] = 0x77;
    size = rf_exif_of_tiff((struct rf_bytes){place, from->bytes.size}, copied);
    had_note = rf_exif_has_maker_note((struct rf_bytes){place, from->bytes.size});
    assert_false(size > 0 && rf_exif_has_maker_note((struct rf_bytes){copied, size}));
    assert_true(size <= RF_EXIF_COPY_ROOM && copied[RF_EXIF_COPY_ROOM] == 0x77);
    guarded_destroy(&guarded);
    return size;
}

/* Where the entry of a tag is, in a directory of the copy; NULL: it is not there. */
static const uint8_t *find(uint32_t directory, uint32_t tag, bool high_first)
{
    const uint32_t count = number(copied + directory, 2, high_first);

    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *const at = copied + directory + 2 + 12 * (size_t)i;

        if (number(at, 2, high_first) == tag)
            return at;
    }
    return NULL;
}

static uint32_t main_directory(bool high_first)
{
    return number(copied + 4, 4, high_first);
}

TEST(headers)
{
    for (int high = 0; high < 2; high++) {
        struct block from = block(high, 1);

        entry(&from, TURN, SHORT, 1, 6);
        assert_true(copy(&from) > 0);
        assert_int_equal(number(find(main_directory(high), TURN, high) + 8, 2, high), 6);
        for (size_t size = 1; size < 22; size++) { /* cut before the entry is whole */
            const size_t all = from.bytes.size;

            from.bytes.size = size;
            assert_int_equal(copy(&from), 0);
            from.bytes.size = all;
        }
        for (int at = 0; at < 4; at++) {
            from.bytes.data[at] ^= 1;
            assert_int_equal(copy(&from), 0);
            from.bytes.data[at] ^= 1;
        }
        for (uint32_t i = 0; i < 3; i++) { /* directories behind the file */
            memset(from.bytes.data + 4, i == 2 ? 0xff : 0, 4);
            from.bytes.data[high ? 7 : 4] = i == 2 ? 0xff : (uint8_t)(from.bytes.size - 1 + i);
            assert_int_equal(copy(&from), 0);
        }
        bytes_free(&from.bytes);
    }
}

/* Values that are too large, of no known type, without bytes or outside of the file are left out,
 * as is all that is not shared; what stands between them is copied. */
TEST(left_out)
{
    for (int high = 0; high < 2; high++) {
        struct block from = block(high, 9);
        const uint32_t text = 10 + 9 * 12 + 4, size = text + 16386;
        const uint8_t *model;

        entry(&from, COLOURS, SHORT, 1, 2);
        entry(&from, ARTIST, ASCII, 16385, text);
        entry(&from, ARTIST, 14, 1, 5);
        entry(&from, ARTIST, 0, 1, 5);
        entry(&from, ARTIST, ASCII, 0, text);
        entry(&from, ARTIST, ASCII, 5, size - 4);
        entry(&from, ARTIST, RATIONAL, 0x20000001, text); /* 2^32 + 8 bytes */
        entry(&from, ARTIST, ASCII, 5, size + 1);
        entry(&from, MODEL, ASCII, 5, size - 5);
        bytes_number(&from.bytes, 0, 4, high);
        while (from.bytes.size < size - 5)
            bytes_add(&from.bytes, "x", 1);
        bytes_add(&from.bytes, "Model", 5);
        assert_true(copy(&from) > 0);
        assert_int_equal(number(copied + main_directory(high), 2, high), 1);
        model = find(main_directory(high), MODEL, high);
        assert_memory_equal(copied + number(model + 8, 4, high), "Model", 5);
        bytes_free(&from.bytes);
    }
}

/* Settings are copied but for the maker's note; a directory of them that is empty, behind the file
 * or counted otherwise is left out, and what follows stays. */
TEST(settings)
{
    for (int i = 0; i < 12; i++) {
        const bool high = i % 2;
        const int way = i / 2;
        struct block from = block(high, 2);
        const uint32_t below = 10 + 2 * 12 + 4, value = below + 2 + 3 * 12 + 4;
        const bool is_good = way <= 1;
        uint32_t directory;

        entry(&from, way == 1 ? PLACE : SETTINGS, way == 5 ? SHORT : LONG, way == 4 ? 2 : 1,
              way == 2   ? value + 8
              : way == 4 ? below
              : way == 5 ? 8
                         : below);
        entry(&from, TURN, SHORT, 1, 3);
        bytes_number(&from.bytes, 0, 4, high);
        bytes_number(&from.bytes, way == 3 ? 0 : 3, 2, high);
        entry(&from, MAKER_NOTE, BYTE, 8, value);
        entry(&from, F_NUMBER, RATIONAL, 1, value);
        entry(&from, OTHERS, LONG, 1, 8);
        bytes_number(&from.bytes, 0, 4, high);
        bytes_number(&from.bytes, 18, 4, high);
        bytes_number(&from.bytes, 10, 4, high);
        assert_true(copy(&from) > 0);
        assert_int_equal(had_note, way == 0);
        directory = main_directory(high);
        assert_int_equal(number(copied + directory, 2, high), is_good ? 2 : 1);
        assert_int_equal(number(find(directory, TURN, high) + 8, 2, high), 3);
        if (is_good) {
            const uint8_t *const to = find(directory, way ? PLACE : SETTINGS, high);
            const uint8_t *f_number;

            assert_int_equal(number(to + 2, 2, high), LONG);
            directory = number(to + 8, 4, high);
            assert_int_equal(number(copied + directory, 2, high), 1);
            f_number = find(directory, F_NUMBER, high);
            assert_non_null(f_number);
            assert_int_equal(number(copied + number(f_number + 8, 4, high), 4, high), 18);
        }
        bytes_free(&from.bytes);
    }
}

/* As many values as there is room for; a directory for more entries than that is none. */
TEST(room)
{
    enum { TEXTS = 6, LENGTH = 16383 };
    struct block from = block(true, TEXTS), many = block(true, 6000);
    const uint32_t text = 10 + TEXTS * 12 + 4;
    uint32_t directory;

    for (int i = 0; i < TEXTS; i++)
        entry(&from, ARTIST, ASCII, LENGTH, text);
    bytes_number(&from.bytes, 0, 4, true);
    for (int i = 0; i < LENGTH; i++)
        bytes_add(&from.bytes, "t", 1);
    assert_true(copy(&from) > 3 * LENGTH);
    directory = main_directory(true);
    assert_int_equal(number(copied + directory, 2, true), 3);
    assert_int_equal(number(copied + directory + 2 + 3 * 12, 4, true),
                     0); /* nothing is left behind */
    for (int i = 0; i < 3; i++) {
        const uint32_t at = number(copied + directory + 2 + 12 * (size_t)i + 8, 4, true);

        assert_true(at % 2 == 0 && copied[at] == 't' && copied[at + LENGTH - 1] == 't');
    }
    for (int i = 0; i < 6000; i++)
        entry(&many, TURN, SHORT, 1, 1);
    assert_int_equal(copy(&many), 0);
    bytes_free(&from.bytes);
    bytes_free(&many.bytes);
}

TEST(texts_and_places)
{
    struct block from = block(false, 4);
    const uint32_t below = 10 + 4 * 12 + 4, value = below + 2 + 12 + 4;
    struct rf_bytes exif;
    char text[8];

    entry(&from, ARTIST, ASCII, 3, 'A' | 'b' << 8);
    entry(&from, MODEL, ASCII, 10, value);
    entry(&from, TURN, SHORT, 1, 1);
    entry(&from, PLACE, LONG, 1, below);
    bytes_number(&from.bytes, 0, 4, false);
    bytes_number(&from.bytes, 1, 2, false);
    entry(&from, 2, ASCII, 10, value);
    bytes_number(&from.bytes, 0, 4, false);
    bytes_add(&from.bytes, "Some words", 10);
    exif = (struct rf_bytes){from.bytes.data, from.bytes.size};
    assert_true(rf_exif_text(exif, ARTIST, text, sizeof text));
    assert_string_equal(text, "Ab");
    assert_true(rf_exif_text(exif, MODEL, text, sizeof text));
    assert_string_equal(text, "Some wo");
    assert_false(rf_exif_text(exif, TURN, text, sizeof text));
    assert_false(rf_exif_text(exif, F_NUMBER, text, sizeof text));
    assert_false(rf_exif_text((struct rf_bytes){from.bytes.data, 7}, MODEL, text, sizeof text));
    assert_true(rf_exif_directory(exif, PLACE, 1000, copied) == 2 + 12 + 4 + 10);
    assert_int_equal(number(copied + 2 + 8, 4, false), 1000 + 18);
    assert_memory_equal(copied + 18, "Some words", 10);
    assert_int_equal(rf_exif_directory(exif, SETTINGS, 1000, copied), 0);
    assert_int_equal(rf_exif_directory(exif, MODEL, 1000, copied), 0);
    assert_int_equal(rf_exif_directory((struct rf_bytes){NULL, 0}, PLACE, 0, copied), 0);
    bytes_free(&from.bytes);
}
