/* test_containers.c: boxes of HEIF, directories of camera raw and of EXIF that are laid out in each
 * way that their standards allow, and in ways they do not: which are found, and which are none. */
#include "check.h"

#include <time.h>

#include "exif_copy.h"
#include "format.h"
#include "heif_boxes.h"
#include "heif_turn.h"

static struct rf_bytes whole(struct bytes bytes)
{
    return (struct rf_bytes){bytes.data, bytes.size};
}

/* HEIF --------------------------------------------------------------------------------- */

/* Ways to say how large a box is. */
enum { BY_32, BY_64, TO_THE_END };

static void box(struct bytes *to, const char *type, struct bytes content, int way)
{
    bytes_number(to, way == BY_32 ? 8 + content.size : way == BY_64 ? 1 : 0, 4, true);
    bytes_add(to, type, 4);
    if (way == BY_64)
        bytes_number(to, 16 + content.size, 8, true);
    bytes_join(to, content);
}

/* A file whose picture 7 is turned by the second of two properties. */
struct layout {
    int way;            /* the size of the last boxes is said so */
    int version, large; /* associations have items of 4 bytes, properties of 2 */
    int index;          /* the property that is associated: 2 is the turn */
    int others;         /* associations of item 9 in front */
    bool is_alone;      /* these are a box of their own */
    bool is_empty;      /* the turn says no angle */
};

static void associations(struct bytes *to, const struct layout *layout, int items, int count)
{
    bytes_number(to, (uint64_t)layout->version, 1, true);
    bytes_number(to, (uint64_t)layout->large, 3, true);
    bytes_number(to, (uint64_t)count, 4, true);
    for (int i = 0; i < count; i++) {
        bytes_number(to, items && i == count - 1 ? 7 : 9, layout->version ? 4 : 2, true);
        bytes_number(to, 2, 1, true);
        for (int n = 0; n < 2; n++) {
            const int index = n == 0 ? 1 : i == count - 1 && items ? layout->index : 2;

            bytes_number(to, (uint64_t)(index | (layout->large ? 0x8000 : 0x80)),
                         layout->large ? 2 : 1, true);
        }
    }
}

static struct bytes heif(const struct layout *layout)
{
    struct bytes file = {NULL, 0}, meta = {NULL, 0}, primary = {NULL, 0}, iprp = {NULL, 0};
    struct bytes ipco = {NULL, 0}, turn = {NULL, 0}, own = {NULL, 0}, other = {NULL, 0};

    bytes_number(&primary, 0, 4, true);
    bytes_number(&primary, 7, 2, true);
    bytes_number(&turn, 1, layout->is_empty ? 0 : 1, true);
    box(&ipco, "ispe", bytes_copy("\0\0\0\0\0\0\0\1\0\0\0\1", 12), BY_32);
    box(&ipco, "irot", turn, layout->way);
    box(&iprp, "ipco", ipco, layout->way == TO_THE_END ? BY_32 : layout->way);
    if (layout->is_alone) {
        associations(&other, layout, 0, layout->others);
        box(&iprp, "ipma", other, BY_32);
    }
    associations(&own, layout, 1, 1 + (layout->is_alone ? 0 : layout->others));
    box(&iprp, "ipma", own, layout->way);
    bytes_number(&meta, 0, 4, true);
    box(&meta, "pitm", primary, BY_32);
    box(&meta, "iprp", iprp, layout->way);
    box(&file, "ftyp", bytes_copy("heic\0\0\0\0", 8), BY_32);
    box(&file, "meta", meta, layout->way);
    return file;
}

TEST(heif_layouts)
{
    for (int i = 0; i < 3 * 2 * 2 * 3 * 2; i++) {
        const struct layout layout = {.way = i % 3,
                                      .version = i / 3 % 2,
                                      .large = i / 6 % 2,
                                      .index = 2,
                                      .others = i / 12 % 3,
                                      .is_alone = i / 36};
        struct bytes file = heif(&layout);

        assert_int_equal(rf_heif_orientation(whole(file), 0), 8);
        assert_int_equal(rf_heif_orientation(whole(file), 7), 8);
        assert_int_equal(rf_heif_orientation(whole(file), 8), 1);
        bytes_free(&file);
    }
}

/* Properties that are not there, or say nothing, turn nothing. */
TEST(heif_without_a_turn)
{
    static const struct layout layouts[] = {
        {.index = 0},
        {.index = 1},
        {.index = 3},
        {.index = 127},
        {.index = 2, .is_empty = true},
        {.index = 32767, .large = 1},
    };

    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        struct bytes file = heif(&layouts[i]);

        assert_int_equal(rf_heif_orientation(whole(file), 0), 1);
        bytes_free(&file);
    }
}

/* Each box in turn has a name that nobody looks for, or a size that no box has. */
TEST(heif_without_a_box)
{
    static const char *const names[] = {"meta", "pitm", "iprp", "ipco", "ipma", "irot"};
    static const uint32_t sizes[] = {1, 2, 7, 0x7fffffff, 0xffffffff};
    const struct layout layout = {.index = 2};

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        for (size_t n = 0; n <= sizeof sizes / sizeof *sizes; n++) {
            struct bytes file = heif(&layout);
            size_t at = 0;

            while (memcmp(file.data + at + 4, names[i], 4) != 0)
                at++;
            if (n == 0)
                file.data[at + 4] = 'x';
            for (int k = 0; n > 0 && k < 4; k++)
                file.data[at + (size_t)k] = (uint8_t)(sizes[n - 1] >> (24 - 8 * k));
            assert_int_equal(rf_heif_orientation(whole(file), 0), 1);
            bytes_free(&file);
        }
    }
}

/* Camera raw --------------------------------------------------------------------------- */

static bool is_raw(const void *data, size_t size)
{
    return rf_format_raw.recognise((struct rf_bytes){data, size});
}

/* The makers' own headers, whole and cut by a byte; a dot stands for any byte. */
TEST(raw_headers)
{
    static const struct {
        const char *text;
        size_t size;
    } headers[] = {{"FUJIFILMCCD-RAW", 15},
                   {"IIRO", 4},
                   {"IIRS", 4},
                   {"MMOR", 4},
                   {"IIU\0", 4},
                   {"FOVb", 4},
                   {"\0MRM", 4},
                   {"\1\2\3\4ftypcrx ", 12},
                   {"II*\0\1\2\3\4CR", 10}};

    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        char other[16];

        assert_true(is_raw(headers[i].text, headers[i].size));
        assert_false(is_raw(headers[i].text, headers[i].size - 1));
        memcpy(other, headers[i].text, headers[i].size);
        other[headers[i].size - 1] ^= 1;
        assert_false(is_raw(other, headers[i].size));
    }
    assert_false(is_raw("", 0));
}

/* A TIFF whose first directory has these tags; a SHORT lies in the first two of its four bytes. */
struct tag {
    uint16_t tag, type;
    uint32_t value;
};

static struct bytes tiff(bool high_first, const struct tag *tags, int count)
{
    struct bytes file = {NULL, 0};

    bytes_add(&file, high_first ? "MM\0*" : "II*\0", 4);
    bytes_number(&file, 8, 4, high_first);
    bytes_number(&file, (uint64_t)count, 2, high_first);
    for (int i = 0; i < count; i++) {
        bytes_number(&file, tags[i].tag, 2, high_first);
        bytes_number(&file, tags[i].type, 2, high_first);
        bytes_number(&file, 1, 4, high_first);
        bytes_number(&file, tags[i].value, tags[i].type == 3 ? 2 : 4, high_first);
        if (tags[i].type == 3)
            bytes_number(&file, 0xeeee, 2, high_first);
    }
    bytes_number(&file, 0, 4, high_first);
    return file;
}

enum { LONG = 4, SHORT = 3, REDUCED = 254, COLOURS = 262, TURN = 274, PARTS = 330, DNG = 50706 };

TEST(raw_directories)
{
    static const struct {
        struct tag tags[3];
        int count;
        bool raw;
    } cases[] = {
        {{{DNG, 1, 0x01040000}}, 1, true},
        {{{COLOURS, SHORT, 32803}}, 1, true},
        {{{COLOURS, SHORT, 34892}}, 1, true},
        {{{COLOURS, LONG, 32803}}, 1, true},
        {{{COLOURS, SHORT, 2}}, 1, false},
        {{{COLOURS, SHORT, 2}, {DNG, 1, 0x01040000}}, 2, true},
        {{{REDUCED, LONG, 1}, {PARTS, LONG, 80}}, 2, true},
        {{{REDUCED, LONG, 0}, {PARTS, LONG, 80}}, 2, false},
        {{{REDUCED, LONG, 1}, {TURN, SHORT, 6}}, 2, false},
        {{{REDUCED, LONG, 1}}, 1, false},
        {{{PARTS, LONG, 80}}, 1, false},
        {{{TURN, SHORT, 6}}, 1, false},
    };

    for (size_t i = 0; i < 2 * (sizeof cases / sizeof *cases); i++) {
        const int count = cases[i / 2].count;
        struct bytes file = tiff(i % 2, cases[i / 2].tags, count);
        /* The last entry counts once it is whole. */
        const size_t needed = 10 + 12 * (size_t)count;

        assert_int_equal(is_raw(file.data, file.size), cases[i / 2].raw);
        assert_int_equal(is_raw(file.data, needed), cases[i / 2].raw);
        assert_false(is_raw(file.data, needed - 1) && count == 1);
        assert_false(is_raw(file.data, 9) || is_raw(file.data, 7));
        for (uint32_t far = 0; far < 3; far++) { /* directories that begin behind the file */
            memset(file.data + 4, far == 0 ? 0xff : 0, 4);
            file.data[i % 2 ? 7 : 4] = (uint8_t)(far == 0 ? 0xff : file.size - 2 + far);
            assert_false(is_raw(file.data, file.size));
        }
        bytes_free(&file);
    }
}

#ifdef RF_HAVE_JPEG
static struct refocus_photo *read_preview(struct bytes *file, int expected)
{
    struct refocus_read_limits limits = refocus_read_limits_default();
    struct refocus_photo *photo = NULL;

    limits.raw_preview = 1;
    assert_int_equal(refocus_photo_read_memory(&photo, file->data, file->size, &limits, NULL),
                     expected);
    bytes_free(file);
    return photo;
}

/* The largest of the JPEGs is taken, wherever it lies; one of samples without loss or of 12 bits is
 * none, nor are bytes that begin like one. The directory's orientation turns it. */
TEST(raw_previews)
{
    static const struct {
        int width, height; /* 0: something else */
    } parts[] = {{16, 16}, {0, 1}, {48, 32}, {0, 0}, {32, 16}};
    static const char lossless[] = "\xff\xd8\xff\xc3\0\x0b\x0e\x03\0\x03\0\1\1\x11\0";
    static const char twelve[] = "\xff\xd8\xff\xc1\0\x0b\x0c\x03\0\x03\0\1\1\x11\0";
    static const uint16_t turns[] = {1, 6, 8, 0, 9};

    for (int last = 1; last <= 5; last++) {
        for (size_t t = 0; t < sizeof turns / sizeof *turns; t++) {
            const struct tag tags[] = {{TURN, SHORT, turns[t]}, {DNG, 1, 0x01040000}};
            const bool is_turned = turns[t] == 6 || turns[t] == 8, is_large = last >= 3;
            struct bytes file = tiff(t % 2, tags, 2);
            struct refocus_photo *photo;

            for (int i = 0; i < last; i++) {
                bytes_text(&file, "between\xff\xff");
                if (parts[i].width)
                    bytes_join(&file, make_jpeg(parts[i].width, parts[i].height, false, i % 2));
                else
                    bytes_add(&file, parts[i].height ? twelve : lossless, sizeof lossless - 1);
            }
            photo = read_preview(&file, REFOCUS_OK);
            assert_int_equal(photo->image->width, is_large ? (is_turned ? 32 : 48) : 16);
            assert_int_equal(photo->image->height, is_large ? (is_turned ? 48 : 32) : 16);
            assert_true(has_evidence(photo, "preview"));
            refocus_photo_free(&photo);
        }
    }
}

/* Half a megabyte of segments in each of which the next JPEG begins: gone over from each beginning,
 * it took a minute. The preview before them is found all the same. */
TEST(raw_of_many_beginnings)
{
    const struct tag tag = {DNG, 1, 0x01040000};
    struct bytes file = tiff(false, &tag, 1);
    struct refocus_photo *photo;
    const clock_t begin = clock();

    bytes_join(&file, make_jpeg(48, 32, false, false));
    for (int i = 0; i < 87000; i++)
        bytes_add(&file, "\xff\xfe\0\4\xff\xd8", 6);
    photo = read_preview(&file, REFOCUS_OK);
    assert_int_equal(photo->image->width, 48);
    refocus_photo_free(&photo);
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 10);
}

TEST(raw_without_a_preview)
{
    static const char *const ends[] = {"",
                                       "\xff",
                                       "\xff\xd8",
                                       "\xff\xd8\xff",
                                       "\xff\xd8\xff\xe0",
                                       "\xff\xd8\xff\xd9",
                                       "\xff\xd8\xff\xc3"};
    const struct tag tag = {DNG, 1, 0x01040000};

    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        struct bytes file = tiff(i % 2, &tag, 1);

        bytes_text(&file, ends[i]);
        assert_null(read_preview(&file, REFOCUS_ERR_UNSUPPORTED));
    }
}
#endif
