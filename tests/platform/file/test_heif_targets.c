/* test_heif_targets.c: what a HEIF says to belong to several pictures belongs to one. */
#include "check.h"
#include "../../kernels/guarded.h"
#include "heif_targets.h"

/* A box, or reference box, of numbers of `size` bytes each. */
static void add_box(struct bytes *to, const char *type, const uint32_t *numbers, int count,
                    int size)
{
    bytes_number(to, 8 + (uint64_t)count * (uint64_t)size, 4, true);
    bytes_add(to, type, 4);
    for (int i = 0; i < count; i++)
        bytes_number(to, numbers[i], size, true);
}

static void add_reference(struct bytes *to, const char *type, int size, uint32_t from,
                          const uint32_t *targets, int count)
{
    bytes_number(to, 8 + (uint64_t)size + 2 + (uint64_t)count * (uint64_t)size, 4, true);
    bytes_add(to, type, 4);
    bytes_number(to, from, size, true);
    bytes_number(to, (uint64_t)count, 2, true);
    for (int i = 0; i < count; i++)
        bytes_number(to, targets[i], size, true);
}

static void put_box(struct bytes *to, const char *type, struct bytes content)
{
    bytes_number(to, 8 + content.size, 4, true);
    bytes_add(to, type, 4);
    bytes_join(to, content);
}

/* How a file is laid out; item 3 is its main picture. */
struct layout {
    bool large;       /* numbers of items have four bytes */
    int targets;      /* the first description has these, of 5, 3, 8, ... */
    int most;         /* so many of them are there, as the file says */
    bool swapped;     /* references lie before the main picture's number */
    const char *type; /* type of the first description */
    int extra;        /* bytes behind the last reference */
};

static struct bytes make(const struct layout *layout)
{
    static const uint32_t targets[] = {5, 3, 8, 9};
    const int size = layout->large ? 4 : 2;
    struct bytes file = {NULL, 0}, meta = {NULL, 0}, refs = {NULL, 0}, pitm = {NULL, 0};

    bytes_number(&refs, layout->large ? 1u << 24 : 0, 4, true);
    add_reference(&refs, "dimg", size, 3, targets, 3);
    add_reference(&refs, layout->type, size, 6, targets, layout->targets);
    if (layout->most != layout->targets)
        refs.data[refs.size - (size_t)(layout->targets * size) - 1] = (uint8_t)layout->most;
    add_reference(&refs, "cdsc", size, 7, targets + 2, 2);
    bytes_add(&refs, "\0\0\0\0", (size_t)layout->extra);
    bytes_number(&pitm, layout->large ? 1u << 24 : 0, 4, true);
    bytes_number(&pitm, 3, size, true);
    bytes_number(&meta, 0, 4, true);
    if (layout->swapped)
        put_box(&meta, "iref", refs);
    put_box(&meta, "pitm", pitm);
    add_box(&meta, "iinf", targets, 4, 1);
    if (!layout->swapped)
        put_box(&meta, "iref", refs);
    add_box(&meta, "iprp", targets, 4, 4);
    put_box(&file, "ftyp", bytes_copy("heic\0\0\0\0mif1", 12));
    put_box(&file, "meta", meta);
    put_box(&file, "mdat", bytes_copy("0123456789", 10));
    return file;
}

static uint32_t number(const uint8_t *at, int size)
{
    uint32_t value = 0;

    for (int i = 0; i < size; i++)
        value = value << 8 | at[i];
    return value;
}

/* The content of a box, from `at` on, and its size. */
static const uint8_t *content_of(const uint8_t *at, const uint8_t *end, const char *type,
                                 uint32_t *size)
{
    while (at < end) {
        *size = number(at, 4) - 8;
        assert_in_range(*size, 0, end - at - 8);
        if (memcmp(at + 4, type, 4) == 0)
            return at + 8;
        at += 8 + *size;
    }
    fail_msg("no %s", type);
    return NULL;
}

/* Descriptions and auxiliary images have one target each; all else is as it was, and where it was
 * but for what lies between the two boxes. */
TEST(one_target)
{
    for (int i = 0; i < 16; i++) {
        const int targets = 1 + i / 2 % 4;
        const struct layout layout = {i % 2, targets, targets, false, i < 8 ? "cdsc" : "auxl", 0};
        const int size = layout.large ? 4 : 2, spare = (layout.targets - 1 + 1) * size;
        struct bytes file = make(&layout);
        const uint8_t *const end = file.data + file.size;
        const uint8_t *meta, *pitm, *refs, *box;
        uint8_t *changed;
        uint32_t length, others;

        assert_int_equal(rf_heif_single_targets((struct rf_bytes){file.data, file.size}, &changed),
                         REFOCUS_OK);
        assert_non_null(changed);
        meta = content_of(changed, changed + file.size, "meta", &length);
        assert_memory_equal(changed, file.data, (size_t)(meta - changed) + 4);
        box = content_of(meta + 4, meta + length, "iprp", &others);
        assert_memory_equal(box - 8, file.data + (box - 8 - changed),
                            (size_t)(end - file.data) - (size_t)(box - 8 - changed));
        box = content_of(meta + 4, meta + length, "iinf", &others);
        assert_memory_equal(box, "\5\3\10\11", 4);
        pitm = content_of(meta + 4, meta + length, "pitm", &others);
        assert_int_equal(others, 4 + size + spare);
        assert_int_equal(number(pitm + 4, size), 3);
        for (int n = 0; n < spare; n++)
            assert_int_equal(pitm[4 + size + n], 0);
        refs = content_of(meta + 4, meta + length, "iref", &others) + 4;
        box = content_of(refs, refs + others - 4, "dimg", &length);
        assert_int_equal(number(box + size, 2), 3);
        for (int n = 0; n < 2; n++) {
            box = content_of(box + length, refs + others - 4, n ? "cdsc" : layout.type, &length);
            assert_int_equal(length, 2 + 2 * size);
            assert_int_equal(number(box, size), 6 + n);
            assert_int_equal(number(box + size, 2), 1);
            assert_int_equal(number(box + size + 2, size), n ? 8 : layout.targets > 1 ? 3 : 5);
        }
        free(changed);
        bytes_free(&file);
    }
}

/* Files that are read as they are: of another order, or that are damaged. */
TEST(others)
{
    static const struct layout layouts[] = {{false, 2, 2, true, "cdsc", 0},
                                            {false, 2, 2, false, "cdsc", 3},
                                            {false, 2, 3, false, "cdsc", 0},
                                            {true, 3, 200, false, "cdsc", 0},
                                            {true, 3, 200, false, "auxl", 0}};

    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        struct bytes file = make(&layouts[i]);
        uint8_t *changed;

        assert_int_equal(rf_heif_single_targets((struct rf_bytes){file.data, file.size}, &changed),
                         REFOCUS_OK);
        assert_null(changed);
        bytes_free(&file);
    }
}

/* Cut off anywhere, and with any byte changed, nothing beyond the file is touched. */
TEST(damaged)
{
    static const uint8_t bytes[] = {0, 1, 7, 8, 9, 127, 255};
    const struct layout layout = {false, 2, 2, false, "cdsc", 0};
    struct bytes file = make(&layout);
    struct guarded guarded;

    assert_true(guarded_create(&guarded, file.size));
    for (size_t i = 0; i < file.size * (1 + sizeof bytes); i++) {
        const size_t place = i % file.size, size = i < file.size ? place : file.size;
        uint8_t *const at = guarded_place(&guarded, size, 1, AT_END, 0);
        uint8_t *changed;

        if (size > 0)
            memcpy(at, file.data, size);
        if (i >= file.size)
            at[place] = bytes[i / file.size - 1];
        assert_int_equal(rf_heif_single_targets((struct rf_bytes){at, size}, &changed), REFOCUS_OK);
        assert_true(guarded_intact(&guarded));
        free(changed);
    }
    guarded_destroy(&guarded);
    bytes_free(&file);
}
