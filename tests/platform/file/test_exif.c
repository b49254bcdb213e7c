/* test_exif.c: EXIF that means harm. Each block ends where a page begins that may not be
 * touched, so that a read or a write beyond it ends the test, whatever the compiler; and what a
 * bound refuses without any such read shows in the facts. Taking away any one bound of exif.c
 * fails here. */
#include <math.h>
#include "check.h"

#include "../../kernels/guarded.h"
#include "exif.h"
#include "exif_entries.h"
#include "icc.h"

/* Parse at the end of a page; the block becomes what parsing made of it. */
static bool parse(struct bytes *block, struct rf_exif *exif)
{
    struct guarded guarded;
    uint8_t *place;
    bool good;

    assert_true(guarded_create(&guarded, block->size));
    place = guarded_place(&guarded, block->size, 1, AT_END, 0);
    if (block->size > 0)
        memcpy(place, block->data, block->size);
    good = rf_exif_parse(place, block->size, exif);
    assert_true(guarded_intact(&guarded));
    if (block->size > 0)
        memcpy(block->data, place, block->size);
    guarded_destroy(&guarded);
    return good;
}

static struct rf_exif facts(struct bytes block)
{
    struct rf_exif exif;

    assert_true(parse(&block, &exif));
    bytes_free(&block);
    return exif;
}

TEST(header_is_whole)
{
    struct rf_exif exif;

    for (size_t size = 0; size < 8; size++) {
        struct bytes block = bytes_copy("MM\0*\0\0\0\10", 8);

        block.size = size;
        assert_false(parse(&block, &exif));
        bytes_free(&block);
    }
}

static bool is_portrait(const char *make, uint32_t custom)
{
    struct bytes block = {NULL, 0};

    directory(&block, 2);
    entry(&block, MAKE, ASCII, 6, 8 + 2 + 2 * 12 + 4 + 2 + 12 + 4);
    entry(&block, SETTINGS, LONG, 1, 8 + 2 + 2 * 12 + 4);
    add(&block, 0, 4);
    directory(&block, 1);
    entry_short(&block, CUSTOM_RENDERED, custom);
    add(&block, 0, 4);
    bytes_add(&block, make, 6);
    return facts(block).is_portrait;
}

TEST(portraits_are_told)
{
    assert_true(is_portrait("Apple", 7));
    assert_true(is_portrait("Apple", 8));
    assert_false(is_portrait("Apple", 9)); /* one with depth, but not blurred */
    assert_false(is_portrait("Apple", 6));
    assert_false(is_portrait("Other", 8));
}

static struct bytes with_subject(int type, uint32_t count, uint32_t x, uint32_t y, int sides)
{
    struct bytes block = with_settings(1, 1 + sides);

    entry(&block, SUBJECT_AREA, type, count, x << 16 | y);
    if (sides > 0)
        entry_short(&block, WIDTH, 640);
    if (sides > 1)
        entry(&block, HEIGHT, LONG, 1, 480);
    add(&block, 0, 4);
    return block;
}

/* A point within sides that are known, and nothing else. */
TEST(subject_lies_within)
{
    const struct rf_exif exif = facts(with_subject(SHORT, 2, 320, 479, 2));

    assert_near(exif.subject.x, 320.5 / 640);
    assert_near(exif.subject.y, 479.5 / 480);
    assert_true(facts(with_subject(SHORT, 2, 640, 0, 2)).subject.x == -1);
    assert_true(facts(with_subject(SHORT, 2, 0, 480, 2)).subject.x == -1);
    assert_true(facts(with_subject(SHORT, 2, 0, 0, 1)).subject.x == -1);
    assert_true(facts(with_subject(SHORT, 2, 0, 0, 0)).subject.x == -1);
    assert_true(facts(with_subject(SHORT, 1, 0, 0, 2)).subject.x == -1);
    assert_true(facts(with_subject(SHORT, 9, 8, 8, 2)).subject.x == -1);
    assert_true(facts(with_subject(LONG, 1, 0, 0, 2)).subject.x == -1);
}

/* The number of entries lies within the block. */
TEST(directory_lies_within)
{
    const uint32_t size = 40;
    struct rf_exif exif;

    for (int beyond = -1; beyond <= 16; beyond++) {
        struct bytes block = {NULL, 0};

        bytes_add(&block, "MM\0*", 4);
        add(&block, size + (uint32_t)beyond, 4);
        while (block.size < size)
            add(&block, 0, 1);
        assert_false(parse(&block, &exif));
        bytes_free(&block);
        block = with_settings(1, 0);
        /* offset where the settings are said to be */
        block.data[8 + 2 + 12 + 11] = (uint8_t)(block.size + (size_t)beyond);
        assert_true(parse(&block, &exif));
        assert_true(exif.f_number == 0);
        bytes_free(&block);
    }
}

/* More entries are said than there are. */
TEST(entries_lie_within)
{
    struct rf_exif exif;

    for (size_t rest = 0; rest < 12; rest++) {
        struct bytes block = {NULL, 0};

        directory(&block, 3);
        entry_short(&block, ORIENTATION, 6);
        for (size_t i = 0; i < rest; i++)
            add(&block, 0x77, 1);
        assert_true(parse(&block, &exif));
        assert_int_equal(exif.orientation, 6);
        for (size_t i = 0; i < rest; i++) /* no link to a thumbnail is behind them */
            assert_int_equal(block.data[8 + 2 + 12 + i], 0x77);
        bytes_free(&block);
        block = with_settings(1, 3);
        entry_short(&block, FOCAL_LENGTH_35MM, 28);
        for (size_t i = 0; i < rest; i++)
            add(&block, 0x77, 1);
        assert_true(facts(block).focal_length_35mm == 28);
    }
}

/* The link to the thumbnail's directory, whole, in part, or not there. */
TEST(link_lies_within)
{
    struct rf_exif exif;

    for (size_t rest = 0; rest <= 4; rest++) {
        struct bytes block = {NULL, 0};

        directory(&block, 1);
        entry_short(&block, ORIENTATION, 3);
        for (size_t i = 0; i < rest; i++)
            add(&block, 0x77, 1);
        assert_true(parse(&block, &exif));
        assert_int_equal(exif.orientation, 3);
        for (size_t i = 0; i < rest; i++)
            assert_int_equal(block.data[8 + 2 + 12 + i], rest == 4 ? 0 : 0x77);
        bytes_free(&block);
    }
}

/* Values of 8 bytes: inside, cut off by the end of the block, behind it. */
TEST(values_lie_within)
{
    const uint32_t place = 8 + 2 + 2 * 12 + 4 + 2 + 12;

    for (uint32_t beyond = 0; beyond <= 64; beyond++) {
        struct bytes block = with_settings(1, 1);

        entry(&block, F_NUMBER, RATIONAL, 1, place + beyond);
        add(&block, 28, 4);
        add(&block, 10, 4);
        assert_true(facts(block).f_number == (beyond == 0 ? 2.8 : 0));
    }
}

/* Metres; the greatest numerator is infinity, 0 is not known. */
TEST(distances_are_metres)
{
    static const uint32_t above[] = {5, UINT32_MAX, 0, UINT32_MAX};
    static const double metres[] = {2.5, INFINITY, 0, INFINITY};
    const uint32_t place = 8 + 2 + 2 * 12 + 4 + 2 + 12;

    for (int i = 0; i < 4; i++) {
        struct bytes block = with_settings(1, 1);

        entry(&block, SUBJECT_DISTANCE, RATIONAL, 1, place);
        add(&block, above[i], 4);
        add(&block, i < 3 ? 2 : 0, 4);
        assert_true(facts(block).subject_distance == metres[i]);
    }
}

/* 0x20000000 of 8 bytes are 2^32: none, where sizes have 32 bits. And none has no value. */
TEST(counts_are_possible)
{
    static const uint32_t counts[] = {0, 0x20000000, 0x20000001, 0x80000000, 0xffffffff};

    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        struct bytes block = with_settings(1, 1);

        entry(&block, F_NUMBER, RATIONAL, counts[i], 20);
        assert_true(facts(block).f_number == 0);
        block = (struct bytes){NULL, 0};
        directory(&block, 1);
        entry(&block, MODEL, ASCII, counts[i], 20);
        assert_string_equal(facts(block).camera, "");
    }
}

/* A text ends with its count, and after what there is room for. */
TEST(texts_end)
{
    char text[300];
    struct rf_exif exif;

    memset(text, 'x', sizeof text);
    for (uint32_t count = 1; count <= sizeof text; count++) {
        struct bytes block = {NULL, 0};

        directory(&block, 1);
        entry(&block, MAKE, ASCII, count, count <= 4 ? 0x78787878 : 8 + 2 + 12);
        if (count > 4)
            bytes_add(&block, text, count);
        exif = facts(block);
        assert_int_equal(strlen(exif.camera), count < 47 ? count : 47);
        block = (struct bytes){NULL, 0};
        directory(&block, 1);
        entry(&block, MODEL, ASCII, count, count <= 4 ? 0x78787878 : 8 + 2 + 12);
        if (count > 4)
            bytes_add(&block, text, count);
        exif = facts(block);
        assert_int_equal(strlen(exif.camera), count < 63 ? count : 63);
    }
}

/* A value is taken for what its type says: 8 bytes are not read of a number of 2. */
TEST(types_are_what_they_say)
{
    for (int type = 1; type < RATIONAL; type++) {
        struct bytes block = with_settings(1, 1);

        entry(&block, F_NUMBER, type, 1, 0x01010101);
        assert_true(facts(block).f_number == 0);
        block = with_settings(1, 1);
        entry(&block, FOCAL_LENGTH, type, 1, 0x01010101);
        assert_true(facts(block).focal_length_mm == 0);
        block = with_settings(1, 1);
        entry(&block, FOCAL_LENGTH_35MM, type, 1, 0x00070007);
        assert_true(facts(block).focal_length_35mm == (type == SHORT  ? 7
                                                       : type == LONG ? 0x00070007
                                                                      : 0));
        block = (struct bytes){NULL, 0};
        directory(&block, 1);
        entry(&block, ORIENTATION, type, 1, 0x00060006);
        assert_int_equal(facts(block).orientation, type == SHORT ? 6 : 1);
        block = (struct bytes){NULL, 0};
        directory(&block, 1);
        entry(&block, MODEL, type, 1, 0x41424344);
        assert_int_equal(strlen(facts(block).camera), type == ASCII ? 1 : 0);
    }
}

TEST(orientations_are_1_to_8)
{
    for (uint32_t orientation = 0; orientation <= 10; orientation++) {
        struct bytes block = {NULL, 0};

        directory(&block, 1);
        entry_short(&block, ORIENTATION, orientation);
        assert_int_equal(facts(block).orientation,
                         orientation >= 1 && orientation <= 8 ? orientation : 1);
    }
}

/* Whether the sides of a picture on its side are exchanged. */
static bool exchanges(int orientation, int type, uint32_t count, int second)
{
    struct bytes block = with_settings(orientation, 2);
    struct rf_exif exif;
    size_t at;
    bool changed;

    entry(&block, WIDTH, type, count, 640 << 16);
    at = block.size;
    entry_short(&block, second, 480);
    assert_true(parse(&block, &exif));
    changed = block.data[at + 8] == 640 >> 8;
    assert_true(changed || block.data[at + 8] == 480 >> 8);
    assert_int_equal(block.data[0], 'M');
    assert_int_equal(block.data[3], '*');
    bytes_free(&block);
    return changed;
}

/* Types that TIFF does not have stand in no table, and what has no value is no side. */
TEST(sides_are_exchanged)
{
    for (int orientation = 1; orientation <= 9; orientation++) {
        assert_int_equal(exchanges(orientation, SHORT, 1, HEIGHT),
                         orientation >= 5 && orientation <= 8);
    }
    for (int type = 0; type <= 65535; type++)
        assert_int_equal(exchanges(6, type, 1, HEIGHT), type > 0 && type < RATIONAL);
    assert_false(exchanges(6, SHORT, 0, HEIGHT));
    assert_false(exchanges(6, SHORT, 2, HEIGHT));
    assert_false(exchanges(6, SHORT, 1, HEIGHT + 1));
}

/* Only the other side: nothing to exchange it with. */
TEST(one_side_stays)
{
    static const int tags[] = {WIDTH, HEIGHT};

    for (int i = 0; i < 2; i++) {
        struct bytes block = with_settings(6, 1), before;
        struct rf_exif exif;

        entry_short(&block, tags[i], 480);
        before = bytes_copy(block.data, block.size);
        before.data[8 + 2 + 8 + 1] = 1; /* upright now */
        assert_true(parse(&block, &exif));
        assert_memory_equal(block.data, before.data, block.size);
        bytes_free(&before);
        bytes_free(&block);
    }
}

/* Two numbers of a side are none, whichever of the sides has them. */
TEST(two_heights_are_none)
{
    struct bytes block = with_settings(6, 2), before;
    struct rf_exif exif;

    entry_short(&block, WIDTH, 640);
    entry(&block, HEIGHT, SHORT, 2, 480 << 16);
    before = bytes_copy(block.data, block.size);
    before.data[8 + 2 + 8 + 1] = 1;
    assert_true(parse(&block, &exif));
    assert_memory_equal(block.data, before.data, block.size);
    bytes_free(&before);
    bytes_free(&block);
}

/* ICC.1, 7.2: less than a header is no profile, whatever it says. */
TEST(profiles_have_a_header)
{
    for (size_t size = 0; size <= 128; size++) {
        struct refocus_photo_info info = {.evidence_count = 0};
        struct rf_read read = {.info = &info};
        struct refocus_blob profile = {malloc(size + !size), size};

        for (size_t i = 0; i < size; i++) {
            profile.data[i] = (uint8_t)(i >= 16 && i < 20   ? "RGB "[i - 16]
                                        : i >= 36 && i < 40 ? "acsp"[i - 36]
                                                            : 0);
        }
        assert_int_equal(rf_icc_take(&read, &profile), REFOCUS_OK);
        assert_true((read.icc.data != NULL) == (size == 128));
        assert_null(profile.data);
        free(read.icc.data);
    }
}
