/* test_exif_subject.c: the subject's place in EXIF and the thumbnail stay true of a picture that is
 * turned, cut or shrunk, or are taken out. */
#include "check.h"

#include "exif.h"
#include "exif_entries.h"
#include "exif_subject.h"

/* Settings of a camera with 640 x 480 pixels and a subject of two to four numbers. The values lie
 * behind the directory. */
enum { AREA_ENTRY = 8 + 2 + 2 * 12 + 4 + 2, LOCATION_ENTRY = AREA_ENTRY + 3 * 12 };
enum { AREA_VALUE = AREA_ENTRY + 4 * 12 + 4 };

static struct bytes with_subject(int orientation, uint32_t width, uint32_t height)
{
    struct bytes block = with_settings(orientation, 4);

    entry(&block, SUBJECT_AREA, SHORT, 4, AREA_VALUE);
    entry_short(&block, WIDTH, width);
    entry_short(&block, HEIGHT, height);
    entry(&block, SUBJECT_LOCATION, SHORT, 2, 320 << 16 | 470);
    add(&block, 0, 4);
    add(&block, 320, 2);
    add(&block, 470, 2);
    add(&block, 30, 2);
    add(&block, 20, 2);
    return block;
}

static unsigned number(const struct bytes *block, size_t at)
{
    return (unsigned)block->data[at] << 8 | block->data[at + 1];
}

static void assert_area(const struct bytes *block, unsigned x, unsigned y, unsigned wide,
                        unsigned high)
{
    assert_int_equal(number(block, AREA_VALUE), x);
    assert_int_equal(number(block, AREA_VALUE + 2), y);
    assert_int_equal(number(block, AREA_VALUE + 4), wide);
    assert_int_equal(number(block, AREA_VALUE + 6), high);
    assert_int_equal(number(block, LOCATION_ENTRY), SUBJECT_LOCATION);
    assert_int_equal(number(block, LOCATION_ENTRY + 8), x);
    assert_int_equal(number(block, LOCATION_ENTRY + 10), y);
}

/* Point and rectangle go where the pixels under them go. */
TEST(subject_turns_with_the_picture)
{
    static const unsigned turned[9][4] = {
        {0, 0, 0, 0},     {320, 470, 30, 20}, {319, 470, 30, 20},
        {319, 9, 30, 20}, {320, 9, 30, 20},   {470, 320, 20, 30},
        {9, 320, 20, 30}, {9, 319, 20, 30},   {470, 319, 20, 30},
    };

    for (int orientation = 1; orientation <= 8; orientation++) {
        struct bytes block = with_subject(orientation, 640, 480);
        const unsigned *const t = turned[orientation];
        struct rf_exif exif;

        assert_true(rf_exif_parse(block.data, block.size, &exif));
        assert_area(&block, t[0], t[1], t[2], t[3]);
        assert_near(exif.subject.x, 320.5 / 640); /* the stored one */
        assert_near(exif.subject.y, 470.5 / 480);
        /* Nothing is left to be turned. */
        assert_true(rf_exif_parse(block.data, block.size, &exif));
        assert_area(&block, t[0], t[1], t[2], t[3]);
        bytes_free(&block);
    }
}

static bool mentions(const struct bytes *block, unsigned tag)
{
    const unsigned count = number(block, AREA_ENTRY - 2);

    for (unsigned i = 0; i < count; i++)
        if (number(block, AREA_ENTRY + 12 * (size_t)i) == tag)
            return true;
    return false;
}

/* Beyond sides that are said it cannot be turned. */
TEST(subject_outside_is_dropped)
{
    struct bytes block = with_subject(6, 640, 400);
    struct rf_exif exif;

    assert_true(rf_exif_parse(block.data, block.size, &exif));
    assert_true(exif.subject.x == -1);
    assert_int_equal(number(&block, AREA_ENTRY - 2), 2);
    assert_false(mentions(&block, SUBJECT_AREA));
    assert_false(mentions(&block, SUBJECT_LOCATION));
    assert_true(mentions(&block, WIDTH));
    assert_true(mentions(&block, HEIGHT));
    bytes_free(&block);
}

/* A picture of other sides may be any part of the old one. */
TEST(subject_goes_with_its_size)
{
    static const uint32_t sides[][2] = {{640, 480}, {320, 240}, {640, 400}, {600, 480}};

    for (int i = 0; i < 4; i++) {
        struct bytes block = with_subject(1, 640, 480);

        rf_exif_set_size(block.data, block.size, sides[i][0], sides[i][1]);
        assert_int_equal(number(&block, AREA_ENTRY - 2), i == 0 ? 4 : 2);
        assert_true(mentions(&block, SUBJECT_AREA) == (i == 0));
        assert_true(mentions(&block, SUBJECT_LOCATION) == (i == 0));
        assert_true(mentions(&block, WIDTH) && mentions(&block, HEIGHT));
        bytes_free(&block);
    }
}

/* The focus point of a picture of these stored sides, to which an orientation is applied. */
static bool focus(const struct rf_subject *subject, int width, int height, int orientation,
                  double *x, double *y)
{
    struct refocus_photo_info info = {.stored_width = width,
                                      .stored_height = height,
                                      .orientation = orientation,
                                      .focus_x = -1,
                                      .focus_y = -1};
    struct rf_read read = {.info = &info, .subject = *subject};

    rf_subject_settle(&read);
    assert_int_equal(info.evidence_count, 1);
    *x = info.focus_x * (orientation < 5 ? width : height);
    *y = info.focus_y * (orientation < 5 ? height : width);
    return info.focus_x >= 0;
}

/* 2398,1575 of 4032 x 3024, in pictures whose pixels were turned and whose EXIF was not. */
TEST(turned_pixels_turn_the_point)
{
    struct rf_subject subject = {2398.5 / 4032, 1575.5 / 3024, 4032, 3024, 1, 6};
    double x, y;

    assert_true(focus(&subject, 4032, 3024, 1, &x, &y));
    assert_near(x, 2398.5);
    assert_near(y, 1575.5);
    assert_true(focus(&subject, 4032, 3024, 6, &x, &y)); /* the reader turns both */
    assert_near(x, 1448.5);
    assert_near(y, 2398.5);
    assert_true(focus(&subject, 3024, 4032, 1, &x, &y));
    assert_near(x, 1448.5);
    assert_near(y, 2398.5);
    assert_true(focus(&subject, 756, 1008, 1, &x, &y)); /* It is shrunk, too. */
    assert_near(x, 1448.5 / 4);
    subject.held = 8;
    assert_true(focus(&subject, 3024, 4032, 1, &x, &y));
    assert_near(x, 1575.5);
    assert_near(y, 4032 - 2398.5);
    subject.held = 0;
    assert_false(focus(&subject, 3024, 4032, 1, &x, &y));
    subject.orientation = 6; /* It is stale, but says how it was held. */
    assert_true(focus(&subject, 3024, 4032, 1, &x, &y));
    assert_near(x, 1448.5);
    /* It may be either that the sides are those of the upright picture: not known. */
    assert_false(focus(&subject, 3024, 4032, 6, &x, &y));
    /* A part of the picture, whichever. */
    assert_false(focus(&subject, 4032, 2268, 1, &x, &y));
    assert_false(focus(&subject, 3024, 3024, 1, &x, &y));
}

static int held(int32_t x, int32_t y, uint32_t count, const char *lens)
{
    const uint32_t note = 8 + 2 + 2 * 12 + 4 + 2 + 2 * 12 + 4, note_bytes = 14 + 2 + 12 + 4 + 24;
    struct bytes block = with_settings(1, 2);
    struct rf_exif exif;

    entry(&block, MAKER_NOTE, UNDEFINED, note_bytes, note);
    entry(&block, LENS_MODEL, ASCII, 6, note + note_bytes);
    add(&block, 0, 4);
    bytes_add(&block, "Apple iOS\0\0\1MM", 14);
    add(&block, 1, 2);
    entry(&block, 8, SIGNED_RATIONAL, count, 14 + 2 + 12 + 4);
    add(&block, 0, 4);
    add(&block, (uint32_t)x, 4);
    add(&block, 1000, 4);
    add(&block, (uint32_t)y, 4);
    add(&block, 1000, 4);
    add(&block, 50, 4);
    add(&block, 1000, 4);
    bytes_add(&block, lens, 6);
    assert_true(rf_exif_parse(block.data, block.size, &exif));
    bytes_free(&block);
    return exif.subject.held;
}

TEST(gravity_says_how_a_phone_was_held)
{
    assert_int_equal(held(-105, -989, 3, "back\0"), 6);
    assert_int_equal(held(105, 989, 3, "back\0"), 8);
    assert_int_equal(held(-997, 34, 3, "back\0"), 0); /* on its side, nothing is turned */
    assert_int_equal(held(500, -500, 3, "back\0"), 0);
    assert_int_equal(held(-105, -989, 3, "front"), 0); /* may be mirrored */
    assert_int_equal(held(-105, -989, 1, "back\0"), 0);
}

/* Main directory of one entry, the thumbnail's right behind it, and 32 bytes. */
enum { THUMBNAIL = 8 + 2 + 12 + 4, DATA = THUMBNAIL + 2 + 2 * 12 + 4 };

static struct bytes with_thumbnail(int tag, uint32_t count, uint32_t place, uint32_t bytes)
{
    struct bytes block = {NULL, 0};

    directory(&block, 1);
    entry_short(&block, ORIENTATION, 1);
    add(&block, THUMBNAIL, 4);
    directory(&block, 2);
    entry(&block, tag, LONG, count, place);
    entry(&block, tag == 0x111 ? 0x117 : 0x202, LONG, count, bytes);
    add(&block, 0, 4);
    for (int i = 0; i < 32; i++)
        add(&block, 0x77, 1);
    return block;
}

/* Bytes of the picture that are left; everything before the thumbnail's directory stays, but for
 * the link. */
static int left(struct bytes block)
{
    const struct bytes before = bytes_copy(block.data, block.size);
    struct rf_exif exif;
    int n = 0;

    assert_true(rf_exif_parse(block.data, block.size, &exif));
    assert_memory_equal(block.data, before.data, THUMBNAIL - 4);
    for (size_t i = THUMBNAIL - 4; i < DATA; i++)
        assert_int_equal(block.data[i], 0);
    for (size_t i = DATA; i < block.size; i++)
        n += block.data[i] == 0x77;
    bytes_free(&block);
    free(before.data);
    return n;
}

TEST(thumbnails_are_erased)
{
    struct bytes block;

    assert_int_equal(left(with_thumbnail(0x201, 1, DATA, 32)), 0);
    assert_int_equal(left(with_thumbnail(0x201, 1, DATA + 4, 20)), 12);
    assert_int_equal(left(with_thumbnail(0x201, 1, DATA + 8, 0xffffffff)), 8);
    assert_int_equal(left(with_thumbnail(0x201, 1, 0xffffffff, 0xffffffff)), 32);
    assert_int_equal(left(with_thumbnail(0x201, 1, DATA + 32, 1)), 32);
    /* The main directory is none of it. */
    assert_int_equal(left(with_thumbnail(0x201, 1, 0, 100)), 32);
    assert_int_equal(left(with_thumbnail(0x201, 1, 8, 100)), 32);
    assert_int_equal(left(with_thumbnail(0x201, 1, THUMBNAIL - 5, 100)), 32);
    assert_int_equal(left(with_thumbnail(0x111, 1, DATA, 32)), 0);
    /* Two strips: places and sizes lie behind the picture. */
    block = with_thumbnail(0x111, 2, DATA + 32, DATA + 40);
    add(&block, DATA, 4);
    add(&block, DATA + 20, 4);
    add(&block, 10, 4);
    add(&block, 12, 4);
    assert_int_equal(left(block), 10);
}
