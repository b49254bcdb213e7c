/* test_npy.c: arrays of NumPy, of every type, order and shape that is a depth map, and others. */
#include "check.h"
#include "make_formats.h"

#include <math.h>

/* As numpy.save() writes it. */
static struct bytes array(const char *descr, const char *order, const char *shape,
                          const void *samples, size_t size)
{
    char header[128];

    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }  \n",
             descr, order, shape);
    return make_npy(1, header, samples, size);
}

/* Two values of each type, as bits of the low byte first, and as floats. */
static const struct {
    const char *type;
    int bytes;
    uint64_t bits[2];
    float value[2];
} types[] = {
    {"i1", 1, {0x80, 0x7f}, {-128, 127}},
    {"i2", 2, {0x8000, 0x7fff}, {-32768, 32767}},
    {"u4", 4, {0xffffffff, 7}, {4294967296.0f, 7}},
    {"i4", 4, {0xffffffff, 0x80000000}, {-1, -2147483648.0f}},
    {"u8", 8, {UINT64_C(1) << 63, 1}, {9223372036854775808.0f, 1}},
    {"i8", 8, {UINT64_C(1) << 63, UINT64_MAX}, {-9223372036854775808.0f, -1}},
    {"f2", 2, {0x3c00, 0xc100}, {1, -2.5f}},
    {"f2", 2, {0x0001, 0x7bff}, {1 / 16777216.0f, 65504}},
    {"f2", 2, {0x7c00, 0xfc00}, {INFINITY, -INFINITY}},
    {"f4", 4, {0x3f800000, 0xff800000}, {1, -INFINITY}},
    {"f8", 8, {UINT64_C(0x3ff8000000000000), UINT64_C(0xc000000000000000)}, {1.5f, -2}},
    {"f8", 8, {UINT64_C(0x7fefffffffffffff), UINT64_C(0xffefffffffffffff)}, {INFINITY, -INFINITY}},
};

TEST(numbers_of_every_type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        for (int high_first = 0; high_first < 2; high_first++) {
            struct bytes samples = {NULL, 0};
            struct refocus_photo *photo;
            char descr[8];

            snprintf(descr, sizeof descr, "%c%s", high_first ? '>' : '<', types[i].type);
            for (int k = 0; k < 2; k++)
                bytes_number(&samples, types[i].bits[k], types[i].bytes, high_first);
            photo = read_depth(array(descr, "False", "(1, 2)", samples.data, samples.size), NULL,
                               REFOCUS_OK);
            assert_string_equal(photo->info->container, "NPY");
            for (int k = 0; k < 2; k++) {
                assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_F32);
                assert_true(float_at(photo->depth, k, 0) == types[i].value[k]);
            }
            refocus_photo_free(&photo);
            bytes_free(&samples);
        }
    }
}

TEST(no_number_is_none)
{
    static const struct {
        const char *type;
        const char *bits;
        int bytes;
    } nans[] = {
        {"<f2", "\1\174", 2}, {">f4", "\177\300\0\0", 4}, {"<f8", "\1\0\0\0\0\0\370\177", 8}};

    for (size_t i = 0; i < sizeof nans / sizeof *nans; i++) {
        struct refocus_photo *photo =
            read_depth(array(nans[i].type, "False", "(1, 1)", nans[i].bits, (size_t)nans[i].bytes),
                       NULL, REFOCUS_OK);

        assert_true(isnan(float_at(photo->depth, 0, 0)));
        refocus_photo_free(&photo);
    }
}

TEST(codes_stay_codes)
{
    struct refocus_photo *photo =
        read_depth(array("|u1", "False", "(2, 3)", "\1\2\3\4\5\377", 6), NULL, REFOCUS_OK);

    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U8);
    assert_int_equal(photo->depth->width, 3);
    assert_int_equal(photo->depth->height, 2);
    assert_int_equal(sample_at(photo->depth, 2, 1), 255);
    assert_true(photo->depth->value_near == 255);
    refocus_photo_free(&photo);
    photo = read_depth(array(">u2", "False", "(2, 1)", "\1\2\377\376", 4), "mm", REFOCUS_OK);
    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U16);
    assert_int_equal(sample_at(photo->depth, 0, 0), 0x102);
    assert_int_equal(sample_at(photo->depth, 0, 1), 0xfffe);
    assert_near(photo->depth->metres_per_unit, 0.001);
    refocus_photo_free(&photo);
}

/* Rows and columns; batches of one, one channel; versions; blanks, quotes, order and Python 2. */
TEST(forms_of_one_array)
{
    static const struct {
        int version;
        const char *header, *samples;
    } forms[] = {
        {1, "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }", "\1\2\3\4\5\6"},
        {1, "{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3), }", "\1\4\2\5\3\6"},
        {2, "{'descr': '<u1', 'fortran_order': False, 'shape': (1, 2, 3)}", "\1\2\3\4\5\6"},
        {3, "{'shape': (1, 1, 2, 3, 1), 'fortran_order': False, 'descr': '|u1'}", "\1\2\3\4\5\6"},
        {1, "{\"descr\":\"|u1\",\"fortran_order\":False,\"shape\":(2L,3L,)}\n", "\1\2\3\4\5\6"},
        {1, " {\t'descr' : '>u1' ,'fortran_order' : True,'shape':(2, 3, 1)\n}", "\1\4\2\5\3\6"},
    };

    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        struct refocus_photo *photo = read_depth(
            make_npy(forms[i].version, forms[i].header, forms[i].samples, 6), NULL, REFOCUS_OK);

        assert_int_equal(photo->depth->width, 3);
        assert_int_equal(photo->depth->height, 2);
        for (int k = 0; k < 6; k++)
            assert_int_equal(sample_at(photo->depth, k % 3, k / 3), k + 1);
        refocus_photo_free(&photo);
    }
}

TEST(shapes_that_are_no_map)
{
    static const char *const shapes[] = {"()", "(4,)", "(2, 2, 3)", "(3, 2, 2)", "(1, 2, 2, 2)"};
    static const char samples[16];

    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        read_depth(array("|u1", "False", shapes[i], samples, sizeof samples), NULL,
                   REFOCUS_ERR_UNSUPPORTED);
    }
    read_depth(array("|u1", "False", "(0, 2)", samples, 16), NULL, REFOCUS_ERR_FORMAT);
    read_depth(array("|u1", "False", "(2, 4294967295)", samples, 16), NULL, REFOCUS_ERR_SIZE);
    read_depth(array("<f8", "False", "(65535, 65535)", samples, 16), NULL, REFOCUS_ERR_SIZE);
}

TEST(types_that_are_no_numbers)
{
    static const char *const descrs[] = {"|b1", "<c8", "|O", "<U3", "<f3", "=f4", "<f16", "f", "<"};
    static const char samples[32];

    for (size_t i = 0; i < sizeof descrs / sizeof *descrs; i++) {
        read_depth(array(descrs[i], "False", "(1, 2)", samples, sizeof samples), NULL,
                   REFOCUS_ERR_UNSUPPORTED);
    }
}

TEST(headers_that_are_damaged)
{
    static const char *const headers[] = {
        "",
        "{}",
        "{",
        "('descr', '|u1')",
        "{'descr': '|u1', 'fortran_order': False}",
        "{'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '|u1' 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '|u1', 'fortran_order': Maybe, 'shape': (1, 2)}",
        "{'descr': '|u1, 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '|u1\", 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2)",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1 2)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (-1, 2)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (,)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': 2}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 4294967296)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1,1,1,1,1,1,1,1,2)}",
        "{'descr': '|u1234567', 'fortran_order': False, 'shape': (1, 2)}",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2), 'colour': True}",
        "{'descr': '|u1', 'fortran_order_of_it': False, 'shape': (1, 2)}",
    };
    struct bytes file;

    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        read_depth(make_npy(1, headers[i], "\1\2", 2), NULL, REFOCUS_ERR_FORMAT);
    for (int version = 0; version < 5; version += 4) {
        read_depth(make_npy(version, "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2)}",
                            "\1\2", 2),
                   NULL, REFOCUS_ERR_UNSUPPORTED);
    }
    file = make_npy(2, "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2)}", "\1\2", 2);
    file.data[11] = 0xff; /* the length of the header */
    read_depth(file, NULL, REFOCUS_ERR_SIZE);
    file = make_npy(2, "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2)}", "\1\2", 2);
    file.data[9] = 1;
    read_depth(file, NULL, REFOCUS_ERR_FORMAT);
    read_photo(array("|u1", "False", "(1, 2)", "\1\2", 2), REFOCUS_ERR_UNSUPPORTED);
}
