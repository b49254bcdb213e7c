/* test_heif_tone_map.c: the gain map of a HEIF container is found, and made the main picture. */
#include "check.h"
#include "../../kernels/guarded.h"
#include "heif_tone_map.h"

static const uint8_t data[] = "metadata";
enum { DATA = sizeof data - 1 };

static void add_box(struct bytes *to, const char *type, struct bytes content)
{
    bytes_number(to, 8 + content.size, 4, true);
    bytes_add(to, type, 4);
    bytes_join(to, content);
}

/* How a file is laid out; its main picture is item 1, its gain map item 2. */
struct layout {
    int version;      /* `iloc` has it */
    int number;       /* bytes of the number of an item, where versions of boxes differ */
    int offset, base; /* bytes of fields in `iloc` */
    bool inside;      /* the data lie in `idat` */
    int pieces;       /* the data are in so many, as the file says */
    int sources;      /* the tone map has so many */
    uint32_t first;   /* number of the first one */
    int past;         /* bytes of the data beyond the end of what they lie in */
    const char *type; /* the tone map has it */
};

static const struct layout plain = {0, 2, 4, 0, false, 1, 2, 1, 0, "tmap"};

static void add_item(struct bytes *iinf, const struct layout *layout, uint32_t number, bool hidden,
                     const char *type)
{
    struct bytes infe = {NULL, 0};

    bytes_number(&infe, (layout->number == 4 ? 3u : 2u) << 24 | hidden, 4, true);
    bytes_number(&infe, number, layout->number, true);
    bytes_number(&infe, 0, 2, true);
    bytes_add(&infe, type, 4);
    bytes_number(&infe, 0, 1, true);
    add_box(iinf, "infe", infe);
}

static void add_location(struct bytes *iloc, const struct layout *layout, uint32_t number,
                         int pieces, uint64_t offset)
{
    bytes_number(iloc, number, layout->version == 2 ? 4 : 2, true);
    if (layout->version > 0)
        bytes_number(iloc, layout->inside, 2, true);
    bytes_number(iloc, 0, 2, true);
    bytes_number(iloc, layout->base ? offset - 1 : 0, layout->base, true);
    bytes_number(iloc, (uint64_t)pieces, 2, true);
    for (int i = 0; i < pieces; i++) {
        bytes_number(iloc, layout->base ? 1 : offset, layout->offset, true);
        bytes_number(iloc, DATA, 4, true);
    }
}

/* The file is made twice: once to know where its data lie. */
static struct bytes make_at(const struct layout *layout, size_t at)
{
    struct bytes file = {NULL, 0}, meta = {NULL, 0}, pitm = {NULL, 0}, iinf = {NULL, 0};
    struct bytes iref = {NULL, 0}, dimg = {NULL, 0}, iloc = {NULL, 0}, idat = {NULL, 0};

    bytes_number(&pitm, layout->number == 4 ? 1u << 24 : 0, 4, true);
    bytes_number(&pitm, 1, layout->number, true);
    bytes_number(&iinf, layout->number == 4 ? 1u << 24 : 0, 4, true);
    bytes_number(&iinf, 3, layout->number, true);
    add_item(&iinf, layout, 1, false, "hvc1");
    add_item(&iinf, layout, 2, true, "hvc1");
    add_item(&iinf, layout, 3, false, layout->type);
    bytes_number(&iref, layout->number == 4 ? 1u << 24 : 0, 4, true);
    bytes_number(&dimg, 9, layout->number, true);
    bytes_number(&dimg, 0, 2, true);
    add_box(&iref, "dimg", dimg);
    dimg = (struct bytes){NULL, 0};
    bytes_number(&dimg, 3, layout->number, true);
    bytes_number(&dimg, (uint64_t)layout->sources, 2, true);
    for (int i = 0; i < layout->sources; i++)
        bytes_number(&dimg, i ? 2 : layout->first, layout->number, true);
    add_box(&iref, "dimg", dimg);
    bytes_number(&iloc, (uint64_t)layout->version << 24, 4, true);
    bytes_number(&iloc, (uint64_t)layout->offset << 12 | 4 << 8 | (uint64_t)layout->base << 4, 2,
                 true);
    bytes_number(&iloc, 3, layout->version == 2 ? 4 : 2, true);
    add_location(&iloc, layout, 1, 3, 5);
    add_location(&iloc, layout, 2, 0, 1);
    add_location(&iloc, layout, 3, layout->pieces,
                 (layout->inside ? 2 : at) + (uint64_t)layout->past);
    bytes_add(&idat, "ab", 2);
    bytes_add(&idat, data, DATA);
    bytes_number(&meta, 0, 4, true);
    add_box(&meta, "pitm", pitm);
    add_box(&meta, "iinf", iinf);
    add_box(&meta, "iref", iref);
    add_box(&meta, "iloc", iloc);
    add_box(&meta, "idat", idat);
    add_box(&file, "ftyp", bytes_copy("heic\0\0\0\0mif1", 12));
    add_box(&file, "meta", meta);
    add_box(&file, "mdat", bytes_copy(data, DATA));
    return file;
}

static struct bytes make(const struct layout *layout)
{
    struct bytes first = make_at(layout, 0);
    const size_t at = first.size - DATA;

    bytes_free(&first);
    return make_at(layout, at);
}

static struct rf_bytes whole(struct bytes file)
{
    return (struct rf_bytes){file.data, file.size};
}

/* Each way to write numbers and places. */
TEST(found)
{
    for (int version = 0; version <= 2; version++) {
        for (int i = 0; i < 16; i++) {
            struct layout layout = plain;
            struct rf_heif_tone_map map;
            struct bytes file;

            layout.version = version;
            layout.number = i & 1 ? 4 : 2;
            layout.offset = i & 2 ? 8 : 4;
            layout.base = i & 4 ? 4 : 0;
            layout.inside = i & 8 && version > 0;
            file = make(&layout);
            assert_true(rf_heif_find_tone_map(whole(file), &map));
            assert_int_equal(map.item, 2);
            assert_int_equal(map.metadata.size, DATA);
            assert_memory_equal(map.metadata.data, data, DATA);
            bytes_free(&file);
        }
    }
}

/* Tone maps of other pictures than the main one, or of none, and data at an unknown place. */
TEST(others)
{
    struct layout layouts[8];

    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        layouts[i] = plain;
    layouts[0].type = "grid";
    layouts[1].first = 7;
    layouts[2].first = 2;
    layouts[3].sources = 1;
    layouts[4].sources = 3;
    layouts[5].pieces = 2;
    layouts[6].past = 1;
    layouts[7].version = 1, layouts[7].inside = true, layouts[7].past = 1;
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        struct bytes file = make(&layouts[i]);
        struct rf_heif_tone_map map;

        assert_false(rf_heif_find_tone_map(whole(file), &map));
        bytes_free(&file);
    }
}

/* The copy differs in the number of the main picture and in one flag. */
TEST(main_picture)
{
    for (int number = 2; number <= 4; number += 2) {
        struct layout layout = plain;
        uint8_t *changed;
        int different = 0;
        struct bytes file;

        layout.number = number;
        file = make(&layout);
        assert_int_equal(rf_heif_with_main_picture(whole(file), 2, &changed), REFOCUS_OK);
        for (size_t i = 0; i < file.size; i++) {
            if (changed[i] != file.data[i]) {
                const bool is_flag = changed[i] == 0;

                assert_int_equal(changed[i], is_flag ? 0 : 2);
                assert_int_equal(file.data[i], 1);
                assert_memory_equal(file.data + i + (is_flag ? -3 - 4 : 1 - number - 4 - 4),
                                    is_flag ? "infe" : "pitm", 4);
                different++;
            }
        }
        assert_int_equal(different, 2);
        free(changed);
        assert_int_equal(rf_heif_with_main_picture(whole(file), 4, &changed), REFOCUS_ERR_FORMAT);
        assert_null(changed);
        assert_int_equal(rf_heif_with_main_picture(whole(file), 65538, &changed),
                         REFOCUS_ERR_FORMAT);
        bytes_free(&file);
    }
}

/* Cut off anywhere, and with any byte changed, nothing beyond the file is touched. */
TEST(damaged)
{
    static const uint8_t values[] = {0, 1, 2, 7, 8, 9, 127, 255};
    struct layout layout = plain;
    struct guarded guarded;
    struct bytes file;

    layout.version = 1;
    layout.inside = true;
    file = make(&layout);
    assert_true(guarded_create(&guarded, file.size));
    for (size_t i = 0; i < file.size * (1 + sizeof values); i++) {
        const size_t place = i % file.size, size = i < file.size ? place : file.size;
        uint8_t *const at = guarded_place(&guarded, size, 1, AT_END, 0);
        struct rf_heif_tone_map map;
        uint8_t *changed;

        if (size > 0)
            memcpy(at, file.data, size);
        if (i >= file.size)
            at[place] = values[i / file.size - 1];
        if (rf_heif_find_tone_map((struct rf_bytes){at, size}, &map)) {
            assert_true(map.metadata.data >= at && map.metadata.size <= size &&
                        map.metadata.data + map.metadata.size <= at + size);
        }
        rf_heif_with_main_picture((struct rf_bytes){at, size}, 2, &changed);
        assert_true(guarded_intact(&guarded));
        free(changed);
    }
    guarded_destroy(&guarded);
    bytes_free(&file);
}

/* 65,535 pieces for each of many items cost no time. */
TEST(many_pieces)
{
    struct bytes file = {NULL, 0}, meta = {NULL, 0}, iloc = {NULL, 0};
    struct layout layout = plain;
    struct bytes model = make(&layout);
    struct rf_heif_tone_map map;
    size_t at;

    bytes_number(&iloc, 2u << 24, 4, true);
    bytes_number(&iloc, 0, 2, true); /* fields of 0 bytes */
    bytes_number(&iloc, 1u << 20, 4, true);
    for (int i = 0; i < 1 << 20; i++) {
        bytes_number(&iloc, 9, 4, true);
        bytes_number(&iloc, 0, 4, true);
        bytes_number(&iloc, 0xffff, 2, true);
    }
    bytes_number(&meta, 0, 4, true);
    for (at = 20 + 8 + 4; memcmp(model.data + at + 4, "iloc", 4) != 0;) {
        const size_t size = (size_t)model.data[at + 2] << 8 | model.data[at + 3];

        bytes_add(&meta, model.data + at, size);
        at += size;
    }
    add_box(&meta, "iloc", iloc);
    add_box(&file, "meta", meta);
    assert_false(rf_heif_find_tone_map(whole(file), &map));
    bytes_free(&file);
    bytes_free(&model);
}
