/* test_plain.c: formats without metadata of depth: PNM and PFM; and the words for depth units. */
#include "check.h"
#include "formats.h"
#include "make_formats.h"

#include <locale.h>
#include <math.h>

static struct bytes text_file(const char *text)
{
    return bytes_copy(text, strlen(text));
}

TEST(ppm_raw_and_plain)
{
    struct bytes raw = text_file("P6 # a comment\n2 2\n255\n");
    struct refocus_photo *photo;

    bytes_add(&raw, "\1\2\3\4\5\6\7\10\11\12\13\14trailing bytes do not matter", 40);
    photo = read_photo(raw, REFOCUS_OK);
    assert_int_equal(photo->image->width, 2);
    assert_int_equal(photo->image->height, 2);
    assert_string_equal(photo->info->container, "PPM");
    assert_memory_equal(pixel_at(photo->image, 1, 1), "\12\13\14", 3);
    assert_null(photo->depth->samples);
    refocus_photo_free(&photo);
    assert_null(photo);
    photo = read_photo(text_file("P3\n1 1 100\n0 50 100\n"), REFOCUS_OK);
    assert_memory_equal(pixel_at(photo->image, 0, 0), "\0\200\377", 3);
    refocus_photo_free(&photo);
}

TEST(pgm_16_bits_as_photo_and_depth)
{
    struct bytes file = text_file("P5\n3 1\n65535\n");
    struct refocus_photo *photo;

    bytes_add(&file, "\0\0\200\0\377\377", 6);
    photo = read_photo(bytes_copy(file.data, file.size), REFOCUS_OK);
    assert_memory_equal(photo->image->plane[0], "\0\0\0\200\200\200\377\377\377", 9);
    refocus_photo_free(&photo);
    photo = read_depth(file, NULL, REFOCUS_OK);
    assert_int_equal(photo->depth->sample, REFOCUS_SAMPLE_U16);
    assert_int_equal(sample_at(photo->depth, 1, 0), 0x8000);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(photo->depth->value_near == 65535 && photo->depth->value_far == 0);
    assert_int_equal(photo->info->depth_source, REFOCUS_DEPTH_SOURCE_FILE);
    assert_null(photo->image->plane[0]);
    refocus_photo_free(&photo);
}

TEST(pgm_white_is_its_greatest_value)
{
    struct refocus_photo *photo = read_depth(text_file("P2 2 1 1000\n0 1000\n"), NULL, REFOCUS_OK);

    assert_true(photo->depth->value_near == 1000);
    refocus_photo_free(&photo);
    photo = read_depth(text_file("P2 2 1 1000\n0 1000\n"), "mm", REFOCUS_OK);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_true(photo->depth->flags == REFOCUS_DEPTH_ZERO_IS_UNKNOWN);
    assert_near(photo->depth->metres_per_unit, 0.001);
    refocus_photo_free(&photo);
}

TEST(pnm_damaged)
{
    static const char *const bad[] = {
        "P6",
        "P6\n",
        "P6 2 2",
        "P6 2 2 255",
        "P6 2 2 255 x",
        "P6 0 2 255 ",
        "P6 2 -2 255 ",
        "P6 2 2 0 xxxxxxxxxxxx",
        "P6 2 2 65536 xxxxxxxxxxxxxxxxxxxxxxxxxx",
        "P2 1 1 5 6",
        "P2 2 1 5 1",
        "P2 1 1 5 x",
        "P5 1 1 10 \377",
        "P6 2 2 255 xxxxxxxxxxx",
    };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        read_photo(text_file(bad[i]), REFOCUS_ERR_FORMAT);
    read_photo(text_file("P6 2147483648 2147483648 255 x"), REFOCUS_ERR_SIZE);
    read_photo(text_file("P6 65535 65535 255 x"), REFOCUS_ERR_SIZE);
    read_photo(text_file("P6 99999999999999999999 1 255 x"), REFOCUS_ERR_FORMAT);
}

/* A PFM of 3 x 2 samples, or pixels of three. */
static struct bytes make_pfm(bool big_endian, const char *kind)
{
    static const float values[6] = {-1.5f, 0.0f, 2.25f, 3.0f, 100.0f, 0.125f};
    struct bytes file = text_file(kind);

    bytes_text(&file, big_endian ? "\n3 2\n1.0\n" : "\n3 2\n-1.0\n");
    for (int i = 0; i < (kind[1] == 'F' ? 18 : 6); i++) {
        uint32_t bits;
        memcpy(&bits, &values[i % 6], 4);
        bytes_number(&file, bits, 4, big_endian);
    }
    return file;
}

TEST(pfm_both_byte_orders)
{
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct refocus_photo *photo = read_depth(make_pfm(big_endian, "Pf"), NULL, REFOCUS_OK);

        assert_int_equal(photo->depth->width, 3);
        assert_int_equal(photo->depth->height, 2);
        /* The file begins with the bottom row. */
        assert_true(float_at(photo->depth, 0, 1) == -1.5);
        assert_true(float_at(photo->depth, 2, 1) == 2.25);
        assert_true(float_at(photo->depth, 1, 0) == 100.0);
        assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISPARITY);
        assert_true(photo->depth->value_near == photo->depth->value_far);
        refocus_photo_free(&photo);
    }
}

/* Light of three colours is a photo: floats as they are, and codes of sRGB beside them. */
/* Lines may end as in Windows; a blank may be a carriage return, and the first sample begin with a
 * line feed. */
TEST(pfm_line_ends)
{
    static const char samples[] = "\n\0\200\77\0\0\0\100";
    static const char *const heads[] = {"Pf\r\n2 1\r\n-1.0\r\n", "Pf\r2 1\r-1.0\r"};

    for (int i = 0; i < 2; i++) {
        struct bytes file = text_file(heads[i]);
        struct refocus_photo *photo;

        bytes_add(&file, samples, 8);
        photo = read_depth(file, NULL, REFOCUS_OK);
        assert_true(float_at(photo->depth, 0, 0) > 1 && float_at(photo->depth, 0, 0) < 1.0001);
        assert_true(float_at(photo->depth, 1, 0) == 2);
        refocus_photo_free(&photo);
    }
}

TEST(pfm_in_colour)
{
    static const float values[6] = {-1.5f, 0.0f, 2.25f, 3.0f, 100.0f, 0.125f};
    static const int codes[6] = {0, 0, 255, 255, 255, 99};

    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct refocus_photo *photo = read_photo(make_pfm(big_endian, "PF"), REFOCUS_OK);

        assert_string_equal(photo->info->container, "PFM");
        assert_int_equal(photo->info->stored_bits, 0);
        assert_int_equal(photo->deep->format, REFOCUS_FORMAT_RGB_FLOAT);
        assert_int_equal(photo->deep->width, 3);
        assert_int_equal(photo->deep->height, 2);
        for (int i = 0; i < 18; i++) { /* the file begins with the bottom row */
            const int x = i / 3 % 3, y = i < 9, c = i % 3;
            float light;

            memcpy(&light, photo->deep->plane[0] + y * photo->deep->stride[0] + 4 * (3 * x + c), 4);
            assert_true(light == values[i % 6]);
            assert_int_equal(pixel_at(photo->image, x, y)[c], codes[i % 6]);
        }
        refocus_photo_free(&photo);
    }
    read_photo(text_file("PF\n3 2\n-1\n...."), REFOCUS_ERR_FORMAT);
    read_photo(text_file("PF\n65535 65535\n-1\n...."), REFOCUS_ERR_SIZE);
}

TEST(pfm_units)
{
    struct refocus_photo *photo = read_depth(make_pfm(false, "Pf"), "inverse", REFOCUS_OK);

    assert_true(photo->depth->value_near == -1.5 && photo->depth->value_far == 100.0);
    refocus_photo_free(&photo);
    photo = read_depth(make_pfm(false, "Pf"), "m", REFOCUS_OK);
    assert_int_equal(photo->depth->meaning, REFOCUS_DEPTH_DISTANCE);
    assert_true(photo->depth->metres_per_unit == 1.0 && photo->depth->metres_at_zero == 0.0);
    refocus_photo_free(&photo);
}

TEST(pfm_refused)
{
    struct bytes tall = text_file("Pf\n2147483648 2147483648\n-1\n....");

    read_depth(make_pfm(false, "PF"), NULL, REFOCUS_ERR_NO_DEPTH);
    read_photo(make_pfm(false, "Pf"), REFOCUS_ERR_UNSUPPORTED);
    read_depth(tall, NULL, REFOCUS_ERR_SIZE);
    read_depth(text_file("Pf\n32768 4096\n-1\n...."), NULL, REFOCUS_ERR_FORMAT);
    read_depth(text_file("Pf\n1 1\n0\n...."), NULL, REFOCUS_ERR_FORMAT);
    read_depth(text_file("Pf\n1.5 1\n-1\n...."), NULL, REFOCUS_ERR_FORMAT);
    read_depth(text_file("Pf\n-1 1\n-1\n...."), NULL, REFOCUS_ERR_FORMAT);
    read_depth(text_file("Pf\n1 1\n-1"), NULL, REFOCUS_ERR_FORMAT);
}

/* The ends of floats are those of the map, not of what lies between its rows. */
TEST(ends_of_floats)
{
    static const float rows[2][4] = {{2, (float)NAN, 5, 90}, {(float)INFINITY, 3, 1, -90}};
    struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                    .sample = REFOCUS_SAMPLE_F32,
                                    .samples = rows,
                                    .width = 3,
                                    .height = 2,
                                    .stride = sizeof rows[0]};

    assert_int_equal(refocus_depth_set_unit(&map, "inverse"), REFOCUS_OK);
    assert_true(map.value_near == 1 && map.value_far == 5);
    assert_int_equal(refocus_depth_set_unit(&map, "disparity"), REFOCUS_OK);
    assert_true(map.value_near == 0 && map.value_far == 0);
}

TEST(unit_words)
{
    static const char *const bad[] = {"",     "M",       "cm",      "m/m",  "/m",    "0/m",
                                      "-1/m", "1e999/m", "5000/mm", "5000", "nan/m", "inf/m"};
    struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                    .sample = REFOCUS_SAMPLE_U8};

    assert_int_equal(refocus_depth_set_unit(&map, "disparity"), REFOCUS_OK);
    assert_true(map.value_near == 255 && map.value_far == 0 && map.flags == 0);
    assert_int_equal(refocus_depth_set_unit(&map, "inverse"), REFOCUS_OK);
    assert_true(map.value_near == 0 && map.value_far == 255);
    map.sample = REFOCUS_SAMPLE_U16;
    assert_int_equal(refocus_depth_set_unit(&map, "inverse"), REFOCUS_OK);
    assert_true(map.value_far == 65535);
    assert_int_equal(refocus_depth_set_unit(&map, "disparity/256"), REFOCUS_OK);
    assert_int_equal(map.meaning, REFOCUS_DEPTH_DISPARITY);
    assert_true(map.value_near == 0 && map.value_far == 0);
    assert_int_equal(refocus_depth_set_unit(&map, "5000/m"), REFOCUS_OK);
    assert_int_equal(map.meaning, REFOCUS_DEPTH_DISTANCE);
    assert_near(map.metres_per_unit, 0.0002);
    assert_int_equal(refocus_depth_set_unit(&map, "2.5e3/m"), REFOCUS_OK);
    assert_near(map.metres_per_unit, 0.0004);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(refocus_depth_set_unit(&map, bad[i]), REFOCUS_ERR_ARGUMENT);
        read_depth(make_pfm(false, "Pf"), bad[i], REFOCUS_ERR_ARGUMENT);
    }
    assert_near(map.metres_per_unit, 0.0004);
    assert_int_equal(refocus_depth_set_unit(NULL, "m"), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_set_unit(&map, NULL), REFOCUS_ERR_ARGUMENT);
}

TEST(invalid_words)
{
    static const char *const bad[] = {"x",         "zero,x",   "ma",        "maxi", ",max",
                                      "max,,zero", "max zero", "1,2,3,4,5", "1e99", "nan"};
    struct refocus_depth_map map = refocus_depth_map_default();

    assert_int_equal(refocus_depth_set_invalid(&map, NULL), REFOCUS_OK);
    assert_int_equal(refocus_depth_set_invalid(&map, ""), REFOCUS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(refocus_depth_set_invalid(&map, bad[i]), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(map.flags, 0);
    assert_int_equal(map.unknown_count, 0);
    assert_int_equal(refocus_depth_set_invalid(&map, "max"), REFOCUS_OK);
    assert_int_equal(map.flags, REFOCUS_DEPTH_MAX_IS_UNKNOWN);
    assert_int_equal(refocus_depth_set_invalid(&map, "2047,zero"), REFOCUS_OK);
    assert_int_equal(map.flags, REFOCUS_DEPTH_ZERO_IS_UNKNOWN | REFOCUS_DEPTH_MAX_IS_UNKNOWN |
                                    REFOCUS_DEPTH_2047_IS_UNKNOWN);
    for (int again = 0; again < 2; again++) {
        assert_int_equal(refocus_depth_set_invalid(&map, "-16,0.1,0"), REFOCUS_OK);
        assert_int_equal(map.unknown_count, 2);
        assert_true(map.unknown[0] == -16 && map.unknown[1] == (double)0.1f);
    }
    map.unknown_count = 0;
    map.struct_size = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m);
    assert_int_equal(refocus_depth_set_invalid(&map, "-16"), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_set_invalid(&map, "max"), REFOCUS_OK);
}

/* A sample that stands for no value is no end of the inverse of floats, be it the least or the
 * greatest. */
TEST(invalid_ends)
{
    static const float samples[] = {-1, 2, 5, 3, 99, 4};
    struct refocus_depth_map map = refocus_depth_map_default();

    map.sample = REFOCUS_SAMPLE_F32;
    map.samples = samples;
    map.width = 3;
    map.height = 2;
    map.stride = 12;
    assert_int_equal(refocus_depth_set_unit(&map, "inverse"), REFOCUS_OK);
    assert_int_equal(refocus_depth_set_invalid(&map, "50"), REFOCUS_OK);
    assert_true(map.value_near == -1 && map.value_far == 99);
    assert_int_equal(refocus_depth_set_invalid(&map, "-1"), REFOCUS_OK);
    assert_true(map.value_near == 2 && map.value_far == 99);
    map.stride = 5;
    assert_int_equal(refocus_depth_set_invalid(&map, "99"), REFOCUS_ERR_ARGUMENT);
    map.stride = 12;
    assert_int_equal(refocus_depth_set_invalid(&map, "99"), REFOCUS_OK);
    assert_true(map.value_near == 2 && map.value_far == 5);
}

TEST(range_overrules)
{
    static const double bad[][2] = {{-1, 0},  {0, -1},  {2, 1},       {1, 1},
                                    {NAN, 0}, {0, NAN}, {INFINITY, 0}};
    struct bytes file = text_file("P5\n1 1\n255\n\1");
    struct refocus_photo *photo;

    assert_int_equal(refocus_depth_read_memory(&photo, file.data, file.size, "disparity", 0.5,
                                               INFINITY, NULL, NULL),
                     REFOCUS_OK);
    assert_true(photo->depth->near_m == 0.5 && isinf(photo->depth->far_m));
    refocus_photo_free(&photo);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(refocus_depth_read_memory(&photo, file.data, file.size, NULL, bad[i][0],
                                                   bad[i][1], NULL, NULL),
                         REFOCUS_ERR_ARGUMENT);
        assert_null(photo);
    }
    bytes_free(&file);
}

TEST(unknown_content)
{
    struct refocus_reason reason;
    struct refocus_photo *photo;

    read_photo(text_file("GIF89a..........."), REFOCUS_ERR_FORMAT);
    read_photo(text_file(""), REFOCUS_ERR_FORMAT);
    read_photo(text_file("P"), REFOCUS_ERR_FORMAT);
    read_photo(text_file("P4 1 1 x"), REFOCUS_ERR_FORMAT);
    assert_int_equal(refocus_photo_read_memory(&photo, NULL, 0, NULL, &reason), REFOCUS_ERR_FORMAT);
    assert_int_equal(refocus_photo_read_memory(&photo, NULL, 5, NULL, &reason),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_photo_read(&photo, "/does/not/exist.png", NULL, &reason),
                     REFOCUS_ERR_IO);
    assert_null(strstr(reason.text, "exist.png"));
    assert_int_equal(refocus_photo_read(&photo, "/", NULL, &reason), REFOCUS_ERR_IO);
    assert_int_equal(refocus_depth_read(&photo, "/", NULL, 0, 0, NULL, &reason), REFOCUS_ERR_IO);
    assert_null(photo);
    refocus_photo_free(NULL);
}

TEST(limits_are_kept)
{
    const struct refocus_read_limits few_pixels = {
        .struct_size = sizeof(struct refocus_read_limits), .max_pixels = 11};
    const struct refocus_read_limits few_bytes = {.struct_size = sizeof(struct refocus_read_limits),
                                                  .max_bytes = 20};
    struct bytes file = text_file("P5\n4 3\n255\n............");
    struct refocus_reason reason;
    struct refocus_photo *photo;

    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &few_pixels, &reason),
                     REFOCUS_ERR_SIZE);
    assert_non_null(strstr(reason.text, "11"));
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &few_bytes, &reason),
                     REFOCUS_ERR_SIZE);
    bytes_free(&file);
}

TEST(numbers_ignore_the_locale)
{
    /* Not every machine has one with a decimal comma; with one this is the test. */
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8"))
        setlocale(LC_NUMERIC, "C.UTF-8");
    unit_words(NULL);
    setlocale(LC_NUMERIC, "C");
}

/* "one, two or three", each as it is listed. */
TEST(endings_in_words)
{
    for (int depth = 0; depth < 2; depth++) {
        char words[192], expected[192] = "";
        int count = 0;

        while (refocus_file_ending(depth, count))
            count++;
        for (int i = 0; i < count; i++) {
            strcat(expected, i == 0 ? "" : i == count - 1 ? " or " : ", ");
            strcat(expected, refocus_file_ending(depth, i));
        }
        assert_true(count > 1);
        rf_list_endings(words, sizeof words, depth);
        assert_string_equal(words, expected);
    }
}

TEST(formats_are_named)
{
    assert_non_null(strstr(refocus_file_formats(), "PFM"));
    for (int depth = 0; depth < 2; depth++) {
        assert_non_null(refocus_file_ending(depth, 0));
        assert_non_null(refocus_file_ending(depth, 1));
        assert_string_not_equal(refocus_file_ending(depth, 0), refocus_file_ending(depth, 1));
        assert_null(refocus_file_ending(depth, -1));
    }
#ifdef RF_HAVE_PNG
    assert_non_null(strstr(refocus_file_formats(), "PNG"));
#else
    read_photo(make_png(2, 2, 0, 8), REFOCUS_ERR_UNSUPPORTED);
#endif
#ifndef RF_HAVE_JPEG
    read_photo(bytes_copy("\xff\xd8\xff\xd9", 4), REFOCUS_ERR_UNSUPPORTED);
#endif
#ifndef RF_HAVE_HEIC
    read_photo(bytes_copy("\0\0\0\14ftypheic", 12), REFOCUS_ERR_UNSUPPORTED);
#endif
}

/* This program is linked without the shared library, beside which modules are looked for: each says
 * which library it lacks. */
TEST(modules_are_missed_in_words)
{
    static const struct {
        const char *begin;
        size_t size;
        const char *library;
    } formats[] = {{"II*\0\10\0\0\0", 8, "libtiff"},
                   {"\x76\x2f\x31\x01", 4, "OpenEXR"},
                   {"RIFF\4\0\0\0WEBP", 12, "libwebp"},
                   {"\xff\x0a", 2, "libjxl"},
                   {"PK\3\4", 4, "libzip"}};

    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        struct refocus_photo *photo = NULL;
        struct refocus_reason reason;
        const int status =
            refocus_photo_read_memory(&photo, formats[i].begin, formats[i].size, NULL, &reason);

        /* Where the modules are installed they are found, and the file is damaged. */
        assert_true(status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_UNSUPPORTED);
        assert_true(status == REFOCUS_ERR_FORMAT || strstr(reason.text, formats[i].library));
    }
    /* A sound is in a file of the same kind as WebP. */
    for (size_t size = 4; size <= 12; size++) {
        struct refocus_photo *photo = NULL;
        struct refocus_reason reason;

        assert_int_equal(refocus_photo_read_memory(&photo, "RIFF\4\0\0\0WAVE", size, NULL, &reason),
                         REFOCUS_ERR_FORMAT);
        assert_non_null(strstr(reason.text, "no known format"));
    }
}

#ifdef RF_HAVE_JPEG
TEST(raw_by_its_preview)
{
    struct bytes file = make_dng(32, 32, 20000, make_jpeg(16, 32, false, false));
    struct refocus_read_limits limits = refocus_read_limits_default();
    struct refocus_photo *photo = NULL;

    limits.raw_preview = 1;
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &limits, NULL),
                     REFOCUS_OK);
    assert_string_equal(photo->info->container, "raw");
    assert_int_equal(photo->image->width, 16);
    assert_int_equal(photo->image->height, 32);
    assert_true(pixel_at(photo->image, 2, 2)[0] > 250 && pixel_at(photo->image, 2, 2)[1] < 5);
    assert_true(has_evidence(photo, "preview"));
    assert_null(photo->deep->plane[0]);
    refocus_photo_free(&photo);
    limits.max_pixels = 511;
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &limits, NULL),
                     REFOCUS_ERR_SIZE);
    limits.max_pixels = 0;
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size - 500, &limits, NULL),
                     REFOCUS_ERR_FORMAT);
    bytes_free(&file);
    file = make_dng(32, 32, 20000, (struct bytes){NULL, 0});
    assert_int_equal(refocus_photo_read_memory(&photo, file.data, file.size, &limits, NULL),
                     REFOCUS_ERR_UNSUPPORTED);
    bytes_free(&file);
}
#endif
